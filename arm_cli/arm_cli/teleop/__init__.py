"""`arm teleop`: what keys and a gamepad mean, and the client of servo_node that they move."""
