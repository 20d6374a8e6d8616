"""Seeing: the plane that things stand on, and upright boxes and cylinders on it."""
