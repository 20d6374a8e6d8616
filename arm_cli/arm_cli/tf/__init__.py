"""The verbs of `arm tf`."""
