"""Messages to text and text to messages. Knows the message classes, but no rclpy."""
