"""Motions of industrial arms: point to point, straight lines, arcs, and sequences of them."""
