"""Moves an arm between poses, again and again."""
