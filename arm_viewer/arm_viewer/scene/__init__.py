"""The 3D view: robots, frames, cameras, the world, and the first view."""
