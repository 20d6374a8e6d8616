"""Nodes that use the arm: arm_controller_node, publisher_terminal, publisher_defined."""
