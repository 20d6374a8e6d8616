"""Graphs as SVG, Mermaid, DOT and PDF. Knows nothing of ROS."""
