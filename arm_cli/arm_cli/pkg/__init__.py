"""The verbs of `arm pkg`, which list and create packages."""
