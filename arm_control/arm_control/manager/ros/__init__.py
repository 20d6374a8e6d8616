"""The ROS side of the controller manager: its node, services, topics and process."""
