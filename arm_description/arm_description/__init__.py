"""The 4-DOF arm: xacro, meshes, robot model and kinematics; robot_state_publisher and joint_state_publisher in Python."""
