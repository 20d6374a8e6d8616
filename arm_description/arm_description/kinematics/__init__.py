"""Forward and inverse kinematics, and joints as transforms between frames."""
