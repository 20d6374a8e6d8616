"""Expands xacro files to URDF text, with the line of each error."""
