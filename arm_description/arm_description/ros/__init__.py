"""The package's ROS halves: nodes that declare parameters, convert, wire and log."""
