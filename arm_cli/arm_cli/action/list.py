"""`arm action list`: the actions."""

import argparse

from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-actions", action="store_true", help="only their number")
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the actions."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        actions = graph.actions()
    if options.json:
        print_json([{"name": name, "types": types} for name, types in actions.items()])
    elif options.count_actions:
        print(len(actions))
    else:
        for name, types in actions.items():
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)
