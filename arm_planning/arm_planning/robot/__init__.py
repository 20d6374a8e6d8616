"""The robot as planning sees it: groups of joints, limits, named states, the SRDF."""
