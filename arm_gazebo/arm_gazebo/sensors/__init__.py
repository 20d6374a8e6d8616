"""The cameras and other sensors of a URDF: what they are, not what they read."""
