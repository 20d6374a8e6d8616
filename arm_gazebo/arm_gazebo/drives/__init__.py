"""The servos of a robot's joints, which turn commands into efforts."""
