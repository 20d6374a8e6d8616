"""Collision checks with MuJoCo, and the proof that a motion is free."""
