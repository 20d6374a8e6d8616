"""Coordinate frames from /tf and /tf_static, and the verbs of `arm tf`."""
