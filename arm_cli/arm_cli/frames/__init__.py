"""Coordinate frames as /tf and /tf_static tell them. Knows no rclpy."""
