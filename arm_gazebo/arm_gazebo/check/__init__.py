"""The checks of `arm check`, which start nothing."""
