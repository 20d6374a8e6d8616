"""The verbs of `arm control`, which query and command a controller manager."""
