"""The plan of a launch: its steps, and the events that they wait for."""
