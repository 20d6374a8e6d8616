"""The robot in the simulation as controllers see it: its joints and its sensors."""
