"""The nodes robot_state_publisher and joint_state_publisher; only `ros_*` imports ROS."""
