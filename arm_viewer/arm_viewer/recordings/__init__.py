"""Recordings as the page reads them, without ROS: bags, what a topic said at a time, playing."""
