"""`arm lifecycle nodes`: the nodes with a lifecycle."""

import argparse

from arm_cli.lifecycle.managed_nodes import managed_nodes
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-a", "--all", dest="hidden", action="store_true", help="hidden nodes, too")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="only their number")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the nodes. Controllers are none of them: they show no lifecycle services."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        names = [node.full_name for node in managed_nodes(Graph(session), options.hidden)]
    if options.json:
        print_json(names)
    elif options.count_nodes:
        print(len(names))
    else:
        print(*names, sep="\n", end="\n" if names else "")
