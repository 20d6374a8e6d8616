"""`arm action find`: the actions of a type."""

import argparse

from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.listing import add_count_argument, print_those_of
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("action_type", help="such as control_msgs/action/GripperCommand")
    add_count_argument(parser, "actions")


def run(options: argparse.Namespace) -> None:
    """Print the actions.

    Raises:
        NotFoundError: there is no such type.
    """
    wanted = InterfaceIndex().find(options.action_type, ("action",)).full_name
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        found = graph.actions()
    print_those_of(wanted, found, options)
