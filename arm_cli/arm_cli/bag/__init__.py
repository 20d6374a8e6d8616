"""Bags in rosbag2's layout, and the verbs of `arm bag`."""
