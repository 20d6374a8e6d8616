"""The MuJoCo model: robots put into a world."""
