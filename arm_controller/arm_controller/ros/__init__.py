"""The ROS half of arm_controller: wiring between topics, parameters and the core."""
