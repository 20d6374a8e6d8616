"""Jogging: small motions on command, slowed down before singularities, limits and collisions."""
