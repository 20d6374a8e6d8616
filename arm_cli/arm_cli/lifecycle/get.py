"""`arm lifecycle get`: the state of a managed node, or of all."""

import argparse
import sys

from arm_cli.errors import UnansweredError
from arm_cli.lifecycle.managed_nodes import managed_node, managed_nodes
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("node_name", nargs="?", help="by default every managed node"),
        completers.nodes,
    )
    parser.add_argument(
        "--include-hidden-nodes", dest="hidden", action="store_true", help="hidden nodes, too"
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the states.

    Raises:
        NotFoundError: there is no such node, or it has no lifecycle.
        UnansweredError: the node that was named does not answer.
    """
    states = {}
    with connect() as session:
        from lifecycle_msgs.srv import GetState

        from arm_cli.ros.graph import Graph
        from arm_cli.ros.service_call import call_service

        graph = Graph(session)
        named = [managed_node(graph, options.node_name)] if options.node_name else None
        for node in named or managed_nodes(graph, options.hidden):
            service = f"{node.full_name}/get_state"
            try:
                answer = call_service(session, GetState, service, GetState.Request())
            except UnansweredError as error:
                if options.node_name:
                    raise
                print(f"arm lifecycle get: {error}", file=sys.stderr)
                continue
            states[node.full_name] = answer.current_state
    if options.json:
        print_json({name: state.label for name, state in states.items()})
        return
    for name, state in states.items():
        prefix = "" if options.node_name else f"{name}: "
        print(f"{prefix}{state.label} [{state.id}]")
