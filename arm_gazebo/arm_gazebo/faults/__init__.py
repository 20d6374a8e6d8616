"""Faults on demand: what goes wrong in the simulation because a test asks for it."""
