"""The ROS interface: observes topics and services for snapshots, and serves the page's requests."""
