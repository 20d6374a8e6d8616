"""Graphs as Mermaid, DOT and PDF; `arm_viewer.drawing` makes SVG. Knows nothing of ROS."""
