"""The verbs of `arm param`."""
