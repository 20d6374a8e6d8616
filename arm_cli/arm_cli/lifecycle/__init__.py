"""The verbs of `arm lifecycle`."""
