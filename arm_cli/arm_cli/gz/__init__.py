"""`arm gz`: Gazebo's commands for this simulation, with the output format of Gazebo."""
