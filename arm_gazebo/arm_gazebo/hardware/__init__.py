"""The simulated robot's hardware interface: its joints and its sensors."""
