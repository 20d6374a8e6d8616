"""A controller and a hardware component of your own, as an example."""
