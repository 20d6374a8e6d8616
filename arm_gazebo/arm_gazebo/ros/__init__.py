"""The ROS half of arm_gazebo: topics, services and parameters around the simulation."""
