"""The verbs of `arm sim`."""
