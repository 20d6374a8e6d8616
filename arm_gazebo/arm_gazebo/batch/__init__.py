"""Many copies of one simulation, stepped together."""
