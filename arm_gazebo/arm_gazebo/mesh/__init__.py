"""Mesh files as assets of a MuJoCo model: read, simplified, kept for the next start."""
