"""`arm action send_goal` and its ROS half."""
