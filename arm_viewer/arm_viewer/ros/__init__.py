"""The ROS half: topics and services in, snapshots out; requests in, messages out."""
