"""`arm service list`: the services."""

import argparse

from arm_cli.listing import add_hidden_argument, add_list_arguments, print_list
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_list_arguments(parser, "services")
    add_hidden_argument(parser, "services", "--all")


def run(options: argparse.Namespace) -> None:
    """Print the services."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        services = graph.services(options.hidden)
    print_list(services, options)
