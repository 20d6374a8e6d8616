"""The page: robots, cameras, sliders and plots in a browser; an ordinary ROS node."""
