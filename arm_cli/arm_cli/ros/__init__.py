"""The node of a command, and its view of the ROS graph."""
