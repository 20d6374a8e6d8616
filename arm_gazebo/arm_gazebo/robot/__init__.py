"""Convert a URDF to bodies, joints, shapes and actuators of a MuJoCo model."""
