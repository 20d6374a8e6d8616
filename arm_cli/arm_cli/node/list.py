"""`arm node list`: the nodes."""

import argparse
import sys

from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-a", "--all", dest="hidden", action="store_true", help="hidden nodes, too")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="only their number")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the nodes' names."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        names = [node.full_name for node in graph.nodes(options.hidden)]
    if options.json:
        print_json(names)
    elif options.count_nodes:
        print(len(names))
    else:
        if len(set(names)) < len(names):
            print("WARNING: several nodes share a name; only one of them is seen", file=sys.stderr)
        print(*names, sep="\n", end="\n" if names else "")
