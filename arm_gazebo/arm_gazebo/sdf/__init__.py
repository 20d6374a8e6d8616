"""Gazebo's worlds and models as parts of a MuJoCo model."""
