"""The servos of a robot's joints: commands in, efforts out."""
