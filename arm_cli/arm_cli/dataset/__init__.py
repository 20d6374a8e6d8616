"""Demonstrations for learning: the verbs of `arm dataset`."""
