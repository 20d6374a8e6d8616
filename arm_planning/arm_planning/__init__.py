"""Motion planning for robot arms, without ROS below the node `move_group`."""
