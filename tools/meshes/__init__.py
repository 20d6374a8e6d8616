"""Draws the parts of the robots as solids and writes them to mesh and xacro files.

Sizes are in mm, each part in the frame of its link. The written files are in metres.
"""
