"""The verbs of `arm interface`."""
