"""`arm service info`: a service's type, and how many offer and use it."""

import argparse

from arm_cli.names import absolute_name
from arm_cli.output import add_json_argument, print_json
from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    complete_with(
        parser.add_argument("service_name", help="such as /controller_manager/list_controllers"),
        completers.services,
    )
    add_json_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Print the service's type and its numbers of clients and servers.

    Raises:
        NotFoundError: there is no such service.
    """
    name = absolute_name(options.service_name)
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        types = graph.find_service(name)
        clients, servers = graph.client_count(name), graph.server_count(name)
    if options.json:
        print_json({"types": types, "clients": clients, "services": servers})
        return
    print(f"Type: {types[0] if len(types) == 1 else types}")
    print(f"Clients count: {clients}")
    print(f"Services count: {servers}")
