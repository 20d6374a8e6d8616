"""Build the MuJoCo model of robots in a world."""
