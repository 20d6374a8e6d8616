"""The verbs of `arm pkg`."""
