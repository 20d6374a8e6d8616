"""What `arm doctor` looks at: a check is a class of its own, which knows no ROS."""
