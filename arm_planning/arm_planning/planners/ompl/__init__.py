"""OMPL's planners by name, with the extra `ompl`."""
