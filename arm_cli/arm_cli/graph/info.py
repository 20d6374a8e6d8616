"""`arm topic info`, `arm service info` and `arm action info`: a type and its endpoints."""

import argparse
from typing import Any

from arm_cli.arguments import JSON, Flag, verb
from arm_cli.graph.listing import ACTIONS, SERVICES, TOPICS, name_argument
from arm_cli.names import absolute_name
from arm_cli.output import print_json, say, say_document
from arm_cli.ros.connection import connect
from arm_node.printable import printable


@verb(
    name_argument(TOPICS),
    Flag("-v", "--verbose", help="show every endpoint with its QoS"),
    JSON,
)
def topic_info(options: argparse.Namespace) -> None:
    """Print the topic's type and the numbers of its publishers and subscriptions.

    Raises:
        NoSuchNameError: there is no such topic.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        types = graph.find_topic(options.topic_name)
        topic = absolute_name(options.topic_name)
        publishers, subscriptions = graph.publishers(topic), graph.subscriptions(topic)
    if options.json:
        print_json(
            {
                "types": types,
                "publishers": [_plain(info) for info in publishers],
                "subscriptions": [_plain(info) for info in subscriptions],
            }
        )
        return
    gap = [""] if options.verbose else []
    say(f"Type: {_one_or_all(types)}", *gap)
    for title, infos in (("Publisher", publishers), ("Subscription", subscriptions)):
        say(f"{title} count: {len(infos)}", *gap)
        for info in infos if options.verbose else ():
            say_document(f"{_with_safe_names(info)}\n")


@verb(
    name_argument(SERVICES),
    JSON,
)
def service_info(options: argparse.Namespace) -> None:
    """Print the service's type and its numbers of clients and servers.

    Raises:
        NoSuchNameError: there is no such service.
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
    say(f"Type: {_one_or_all(types)}")
    say(f"Clients count: {clients}")
    say(f"Services count: {servers}")


@verb(
    name_argument(ACTIONS),
    Flag("-t", "--show-types", help="also show their types"),
    Flag("-c", "--count", help="show only their numbers"),
    JSON,
)
def action_info(options: argparse.Namespace) -> None:
    """Print the action's clients and servers.

    Raises:
        NoSuchNameError: there is no such action.
    """
    name = absolute_name(options.action_name)
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        types = graph.find_action(name)
        nodes = graph.nodes(hidden=True)
        clients = [node.full_name for node in nodes if name in graph.action_clients_of(node)]
        servers = [node.full_name for node in nodes if name in graph.action_servers_of(node)]
    if options.json:
        print_json({"types": types, "clients": clients, "servers": servers})
        return
    shown_types = f" [{', '.join(types)}]" if options.show_types else ""
    say(f"Action: {name}")
    for title, names in (("clients", clients), ("servers", servers)):
        say(f"Action {title}: {len(names)}")
        for node_name in [] if options.count else names:
            say(f"    {node_name}{shown_types}")


def _one_or_all(types: list[str]) -> Any:
    return types[0] if len(types) == 1 else types


def _with_safe_names(info: Any) -> Any:
    for name in ("node_name", "node_namespace", "topic_type"):
        setattr(info, name, printable(getattr(info, name)))
    return info


def _plain(info: Any) -> dict[str, Any]:
    profile = info.qos_profile
    return {
        "node": f"{info.node_namespace.rstrip('/')}/{info.node_name}",
        "type": info.topic_type,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "liveliness": profile.liveliness.name.lower(),
    }
