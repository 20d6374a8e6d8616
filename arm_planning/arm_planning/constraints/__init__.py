"""What a goal or a path must satisfy."""
