"""The verbs of `arm node`."""
