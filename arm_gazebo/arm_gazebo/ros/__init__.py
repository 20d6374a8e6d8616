"""The ROS interface of the simulation: topics, services and parameters."""
