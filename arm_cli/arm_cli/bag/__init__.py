"""Recordings in rosbag2's layout: written, read and described. Knows no rclpy."""
