"""The verbs of `arm service`."""
