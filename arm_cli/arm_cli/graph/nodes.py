"""`arm node`: lists the nodes, and shows a node's topics, services and actions."""

import argparse

from arm_cli.arguments import JSON, Argument, Flag, verb
from arm_cli.names import is_hidden
from arm_cli.output import complain, print_json, say
from arm_cli.ros import completers
from arm_cli.ros.connection import connect


@verb(
    Flag("-a", "--all", dest="hidden", help="include hidden nodes"),
    Flag("-c", "--count-nodes", help="print only their number"),
    JSON,
)
def list_nodes(options: argparse.Namespace) -> None:
    """Print the nodes' names."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        names = [node.full_name for node in graph.nodes(options.hidden)]
    if options.json:
        print_json(names)
    elif options.count_nodes:
        say(len(names))
    else:
        if len(set(names)) < len(names):
            complain("WARNING: several nodes share a name; only one of them is visible")
        say(*names)


@verb(
    Argument("node_name", help="such as /controller_manager", completer=completers.nodes),
    Flag("--include-hidden", dest="hidden", help="include hidden topics"),
    JSON,
)
def node_info(options: argparse.Namespace) -> None:
    """Print the node's topics, services and actions.

    Raises:
        NoSuchNameError: there is no such node.
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
    say(node.full_name)
    for title, part in shown.items():
        say(f"  {title}:")
        lines = [f"    {name}: {', '.join(types)}" for name, types in part.items()]
        say(*(lines or [""]))
