"""Sample nodes that command the robots: with typed poses, poses from a file, and actions."""
