"""The format of bags: MCAP files and metadata.yaml, as rosbag2 writes them."""
