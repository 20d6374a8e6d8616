"""Reads XML and YAML launch files, with the elements of ROS 2's frontends."""
