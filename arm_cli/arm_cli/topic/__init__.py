"""The verbs of `arm topic` that publish, print and measure messages."""
