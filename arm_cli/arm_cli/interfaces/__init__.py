"""Interface types: what is installed, and what their files say. Knows no rclpy."""
