"""Forward kinematics, and joints as transforms between frames."""
