"""`arm lifecycle list`: the transitions of a managed node."""

import argparse

from arm_cli.lifecycle.managed_nodes import add_node_argument, managed_node
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_node_argument(parser)
    parser.add_argument(
        "-a", "--all", action="store_true", help="also those that its state does not allow"
    )


def run(options: argparse.Namespace) -> None:
    """Print the transitions.

    Raises:
        NotFoundError: there is no such node, or it has no lifecycle.
        UnansweredError: the node does not answer.
    """
    with connect() as session:
        from lifecycle_msgs.srv import GetAvailableTransitions

        from arm_cli.ros.graph import Graph
        from arm_cli.ros.service_call import call_service

        node = managed_node(Graph(session), options.node_name)
        service = "get_transition_graph" if options.all else "get_available_transitions"
        answer = call_service(
            session,
            GetAvailableTransitions,
            f"{node.full_name}/{service}",
            GetAvailableTransitions.Request(),
        )
    for description in answer.available_transitions:
        print(f"- {description.transition.label} [{description.transition.id}]")
        print(f"\tStart: {description.start_state.label}")
        print(f"\tGoal: {description.goal_state.label}")
