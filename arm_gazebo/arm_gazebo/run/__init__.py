"""The simulation put together without ROS: settings, robots, world, and the order of a tick."""
