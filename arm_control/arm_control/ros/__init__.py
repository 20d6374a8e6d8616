"""The ROS half of arm_control: nodes, messages and services around the core."""
