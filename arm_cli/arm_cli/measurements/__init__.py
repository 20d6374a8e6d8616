"""Rates, bandwidths and delays over windows of messages. Knows no rclpy."""
