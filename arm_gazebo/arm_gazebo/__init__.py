"""The simulation: URDF to MuJoCo, simulated hardware, worlds and cameras."""
