"""`arm service list`: the services."""

import argparse

from arm_cli.output import add_json_argument, print_json
from arm_cli.ros.connection import connect


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count-services", action="store_true", help="only their number")
    parser.add_argument(
        "-a",
        "--all",
        "--include-hidden-services",
        dest="hidden",
        action="store_true",
        help="hidden services, too",
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the services."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        services = graph.services(options.hidden)
    if options.json:
        print_json([{"name": name, "types": types} for name, types in services.items()])
    elif options.count_services:
        print(len(services))
    else:
        for name, types in services.items():
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)
