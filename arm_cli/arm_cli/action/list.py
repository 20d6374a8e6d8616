"""`arm action list`: the actions."""

import argparse

from arm_cli.listing import add_list_arguments, print_list
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_list_arguments(parser, "actions")


def run(options: argparse.Namespace) -> None:
    """Print the actions."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        actions = graph.actions()
    print_list(actions, options)
