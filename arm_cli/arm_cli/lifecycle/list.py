"""`arm lifecycle list`: the transitions of a managed node."""

import argparse

from arm_cli.lifecycle.managed_nodes import managed_node
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("node_name", help="one that `arm lifecycle nodes` lists"),
        completers.nodes,
    )
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
