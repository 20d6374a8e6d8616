"""The verbs of `arm action`."""
