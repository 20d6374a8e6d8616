"""The serial protocol of the myCobot 280."""
