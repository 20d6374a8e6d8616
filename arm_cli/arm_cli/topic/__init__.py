"""The verbs of `arm topic`."""
