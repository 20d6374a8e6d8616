"""Draws graphs: vertices and edges, a layered layout, and SVG."""
