"""Graphs and their pictures, for the page and for `arm graph`. Knows nothing of ROS or viser."""
