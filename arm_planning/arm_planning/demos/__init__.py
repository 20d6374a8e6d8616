"""The demonstrations of MoveIt's task constructor for the myCobot 280, each a task to read."""
