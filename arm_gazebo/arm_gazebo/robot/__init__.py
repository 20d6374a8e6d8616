"""A URDF as part of a MuJoCo model: bodies, joints, shapes, actuators."""
