"""Runs trajectories on controllers: which ones, from where, for how long."""
