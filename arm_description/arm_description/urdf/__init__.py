"""The robot model: URDF text to links, joints and the tree that they make."""
