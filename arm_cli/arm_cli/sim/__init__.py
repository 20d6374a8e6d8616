"""The verbs of `arm sim`, which query and change a running simulation."""
