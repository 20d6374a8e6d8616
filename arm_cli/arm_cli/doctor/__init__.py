"""`arm doctor`: checks without ROS, and the observation of a running simulation by ROS."""
