"""The browser page: robots, cameras, sliders and plots, served by an ordinary ROS node."""
