"""The cameras and other sensors that a URDF describes."""
