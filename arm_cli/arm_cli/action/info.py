"""`arm action info`: an action's clients and servers."""

import argparse

from arm_cli.names import absolute_name
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("action_name", help="such as /gripper_action_controller/gripper_cmd"),
        completers.actions,
    )
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count", action="store_true", help="only their numbers")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the action's clients and servers.

    Raises:
        NotFoundError: there is no such action.
    """
    name = absolute_name(options.action_name)
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        types = graph.find_action(name)
        nodes = graph.nodes(hidden=True)
        clients = [node.full_name for node in nodes if name in graph.action_clients_of(node)]
        servers = [node.full_name for node in nodes if name in graph.action_servers_of(node)]
    if options.json:
        print_json({"types": types, "clients": clients, "servers": servers})
        return
    shown_types = f" [{', '.join(types)}]" if options.show_types else ""
    print(f"Action: {name}")
    for title, names in (("clients", clients), ("servers", servers)):
        print(f"Action {title}: {len(names)}")
        for node_name in [] if options.count else names:
            print(f"    {node_name}{shown_types}")
