"""The parts of the myCobot 280: base, links and gripper.

Sizes, masses and contact shapes are the robot's.
"""
