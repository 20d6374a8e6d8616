"""`arm service find`: the services of a type."""

import argparse

from arm_cli.listing import add_count_argument, add_hidden_argument, print_those_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("service_type", help="such as std_srvs/srv/Trigger")
    add_count_argument(parser, "services")
    add_hidden_argument(parser, "services")


def run(options: argparse.Namespace) -> None:
    """Print the services.

    Raises:
        NotFoundError: there is no such type.
    """
    print_those_of(
        options.service_type, "srv", lambda graph: graph.services(options.hidden), options
    )
