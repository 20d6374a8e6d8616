"""Nodes that move the robots, to copy from: plain rclpy, each in a file of its own.

Begin with `example_gripper_node`, which publishes four commands, and `publisher_terminal_node`,
which publishes the poses that the user types. The modules `ros_*` and `pose` hold what several
nodes share.
"""
