"""The planning scene: objects in the world, objects on the robot, and what may touch."""
