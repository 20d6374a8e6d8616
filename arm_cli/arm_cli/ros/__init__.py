"""The parts of the command that talk to ROS: a node for a moment, and what it asks."""
