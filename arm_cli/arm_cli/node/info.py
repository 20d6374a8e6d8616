"""`arm node info`: what a node publishes, subscribes and serves."""

import argparse

from arm_cli.names import is_hidden
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("node_name", help="such as /controller_manager"), completers.nodes
    )
    parser.add_argument(
        "--include-hidden", dest="hidden", action="store_true", help="hidden topics, too"
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the node's end points.

    Raises:
        NotFoundError: there is no such node.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        node = graph.find_node(options.node_name)
        parts = {
            "Subscribers": graph.subscribed_by(node),
            "Publishers": graph.published_by(node),
            "Service Servers": graph.served_by(node),
            "Service Clients": graph.called_by(node),
            "Action Servers": graph.action_servers_of(node),
            "Action Clients": graph.action_clients_of(node),
        }
    shown = {
        title: {
            name: types for name, types in part.items() if options.hidden or not is_hidden(name)
        }
        for title, part in parts.items()
    }
    if options.json:
        print_json({title.lower().replace(" ", "_"): part for title, part in shown.items()})
        return
    print(node.full_name)
    for title, part in shown.items():
        print(f"  {title}:")
        print(*(f"    {name}: {', '.join(types)}" for name, types in part.items()), sep="\n")
