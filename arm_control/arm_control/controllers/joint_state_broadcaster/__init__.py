"""joint_state_broadcaster/JointStateBroadcaster."""
