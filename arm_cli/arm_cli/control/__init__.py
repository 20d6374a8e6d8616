"""The verbs of `arm control`."""
