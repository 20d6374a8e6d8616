"""Tasks of several stages, planned as a whole, in the words of MoveIt's task constructor."""
