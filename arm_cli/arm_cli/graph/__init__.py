"""The verbs that show the ROS graph: topics, services, actions and nodes."""
