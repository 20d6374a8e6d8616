"""The node move_group: MoveIt 2's topics, services and actions over the planner."""
