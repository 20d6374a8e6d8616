"""What stands in the 3D view."""
