"""`arm service find`: the services of a type."""

import argparse

from arm_cli.interfaces.index import InterfaceIndex
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("service_type", help="such as std_srvs/srv/Trigger")
    parser.add_argument("-c", "--count-services", action="store_true", help="only their number")
    parser.add_argument(
        "-a",
        "--include-hidden-services",
        dest="hidden",
        action="store_true",
        help="hidden services, too",
    )


def run(options: argparse.Namespace) -> None:
    """Print the services.

    Raises:
        NotFoundError: there is no such type.
    """
    wanted = InterfaceIndex().find(options.service_type, ("srv",)).full_name
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        names = [name for name, types in graph.services(options.hidden).items() if wanted in types]
    if options.count_services:
        print(len(names))
    else:
        print(*names, sep="\n", end="\n" if names else "")
