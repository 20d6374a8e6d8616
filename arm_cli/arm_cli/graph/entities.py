"""`list`, `find`, `type` and `info` of topics, services, actions and nodes."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import JSON, Argument, Completer, Flag, VerbFunction, verb
from arm_cli.interface_types import InterfaceIndex
from arm_cli.names import absolute_name, is_hidden
from arm_cli.output import complain, print_json, say, say_answer, say_document
from arm_cli.ros import completers
from arm_cli.ros.connection import connect, settled_graph
from arm_cli.word_completion import message_names
from arm_node.printable import printable

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph


@dataclass(frozen=True, slots=True)
class EntityKind:
    """How topics, services and actions differ in these verbs.

    Attributes:
        noun: the noun, such as "topic".
        type_kind: the kind of their types: "msg", "srv" or "action".
        example: an example of a name, for the help.
        example_type: an example of a type, for the help.
        can_be_hidden: whether lists leave out hidden names by default.
        types: returns the names with their types; the second argument includes hidden names.
        find: returns the types of a name, or raises a NoSuchNameError.
        complete: completes a name.
        complete_type: completes a type; None if there is no completion.
    """

    noun: str
    type_kind: str
    example: str
    example_type: str
    can_be_hidden: bool
    types: Callable[["Graph", bool], dict[str, list[str]]]
    find: Callable[["Graph", str], list[str]]
    complete: Completer
    complete_type: Completer | None = None


TOPICS = EntityKind(
    noun="topic",
    type_kind="msg",
    example="/joint_states",
    example_type="sensor_msgs/msg/Image",
    can_be_hidden=True,
    types=lambda graph, hidden: graph.topics(hidden),
    find=lambda graph, name: graph.find_topic(name),
    complete=completers.topics,
    complete_type=message_names,
)
SERVICES = EntityKind(
    noun="service",
    type_kind="srv",
    example="/controller_manager/list_controllers",
    example_type="std_srvs/srv/Trigger",
    can_be_hidden=True,
    types=lambda graph, hidden: graph.services(hidden),
    find=lambda graph, name: graph.find_service(name),
    complete=completers.services,
)
ACTIONS = EntityKind(
    noun="action",
    type_kind="action",
    example="/gripper_action_controller/gripper_cmd",
    example_type="control_msgs/action/GripperCommand",
    can_be_hidden=False,
    types=lambda graph, hidden: graph.actions(),
    find=lambda graph, name: graph.find_action(name),
    complete=completers.actions,
)


def name_argument(kind: EntityKind) -> Argument:
    """Return the argument for a name."""
    return Argument(f"{kind.noun}_name", completer=kind.complete, help=f"such as {kind.example}")


def list_entities(kind: EntityKind, options: argparse.Namespace) -> None:
    """Print all names, or their number."""
    with settled_graph() as graph:
        found = kind.types(graph, kind.can_be_hidden and options.hidden)
        if getattr(options, "verbose", False) and not (options.json or options.count):
            _print_endpoints(graph, found)
            return
    rows = [{"name": name, "types": types} for name, types in found.items()]
    with_types = (f"{name} [{', '.join(types)}]" for name, types in found.items())
    shown = with_types if options.show_types else found
    say_answer(options, rows, [len(found)] if options.count else shown)


def find_entities(kind: EntityKind, options: argparse.Namespace) -> None:
    """Print the names that have one type, or their number.

    Raises:
        NoSuchNameError: there is no such type.
    """
    type_name = getattr(options, f"{kind.noun}_type")
    wanted = InterfaceIndex().find(type_name, (kind.type_kind,)).full_name
    with settled_graph() as graph:
        found = kind.types(graph, kind.can_be_hidden and options.hidden)
    names = [name for name, types in found.items() if wanted in types]
    if options.count:
        say(len(names))
    else:
        say(*names)


def print_type(kind: EntityKind, options: argparse.Namespace) -> None:
    """Print the type of a name.

    Raises:
        NoSuchNameError: nothing has this name.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph

        say(*kind.find(Graph(session), getattr(options, f"{kind.noun}_name")))


def _print_endpoints(graph: "Graph", topics: dict[str, list[str]]) -> None:
    for title, noun, ask in (
        ("Published topics:", "publisher", graph.publishers),
        ("Subscribed topics:", "subscriber", graph.subscriptions),
    ):
        say(title)
        for name, types in topics.items():
            count = len(ask(name))
            if count:
                plural = "s" if count > 1 else ""
                say(f" * {name} [{', '.join(types)}] {count} {noun}{plural}")
        say("")


def _count(kind: EntityKind) -> Argument:
    flag = f"--count-{kind.noun}s"
    return Flag("-c", flag, dest="count", help="print only their number")


def _hidden(kind: EntityKind, *flags: str) -> list[Argument]:
    if not kind.can_be_hidden:
        return []
    every = f"include hidden {kind.noun}s"
    return [Flag("-a", *flags, f"--include-hidden-{kind.noun}s", dest="hidden", help=every)]


def _list(kind: EntityKind, *more: Argument) -> VerbFunction:
    types = Flag("-t", "--show-types", help="also show their types")
    declare = verb(types, _count(kind), JSON, *_hidden(kind, "--all"), *more)
    return declare(partial(list_entities, kind))


def _find(kind: EntityKind) -> VerbFunction:
    name, example = f"{kind.noun}_type", f"such as {kind.example_type}"
    wanted = Argument(name, completer=kind.complete_type, help=example)
    return verb(wanted, _count(kind), *_hidden(kind))(partial(find_entities, kind))


def _type(kind: EntityKind) -> VerbFunction:
    return verb(name_argument(kind))(partial(print_type, kind))


topic_list = _list(
    TOPICS, Flag("-v", "--verbose", help="show numbers of publishers and subscribers")
)
service_list, action_list = _list(SERVICES), _list(ACTIONS)
topic_find, service_find, action_find = _find(TOPICS), _find(SERVICES), _find(ACTIONS)
topic_type, service_type, action_type = _type(TOPICS), _type(SERVICES), _type(ACTIONS)


@verb(name_argument(TOPICS), Flag("-v", "--verbose", help="show every endpoint with its QoS"), JSON)
def topic_info(options: argparse.Namespace) -> None:
    """Print the topic's type and the numbers of its publishers and subscriptions."""
    with settled_graph() as graph:
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


@verb(name_argument(SERVICES), JSON)
def service_info(options: argparse.Namespace) -> None:
    """Print the service's type and its numbers of clients and servers."""
    name = absolute_name(options.service_name)
    with settled_graph() as graph:
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
    """Print the action's clients and servers."""
    name = absolute_name(options.action_name)
    with settled_graph() as graph:
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


@verb(
    Flag("-a", "--all", dest="hidden", help="include hidden nodes"),
    Flag("-c", "--count-nodes", help="print only their number"),
    JSON,
)
def node_list(options: argparse.Namespace) -> None:
    """Print the nodes' names."""
    with settled_graph() as graph:
        names = [node.full_name for node in graph.nodes(options.hidden)]
    if len(set(names)) < len(names) and not (options.json or options.count_nodes):
        complain("WARNING: several nodes share a name; only one of them is visible")
    say_answer(options, names, [len(names)] if options.count_nodes else names)


@verb(
    Argument("node_name", help="such as /controller_manager", completer=completers.nodes),
    Flag("--include-hidden", dest="hidden", help="include hidden topics"),
    JSON,
)
def node_info(options: argparse.Namespace) -> None:
    """Print the node's topics, services and actions."""
    with settled_graph() as graph:
        node = graph.find_node(options.node_name)
        parts = {
            "Subscribers": graph.subscribed_by(node),
            "Publishers": graph.published_by(node),
            "Service Servers": graph.served_by(node),
            "Service Clients": graph.called_by(node),
            "Action Servers": graph.action_servers_of(node),
            "Action Clients": graph.action_clients_of(node),
        }
    shown = {
        title: {
            name: types for name, types in part.items() if options.hidden or not is_hidden(name)
        }
        for title, part in parts.items()
    }
    if options.json:
        print_json({title.lower().replace(" ", "_"): part for title, part in shown.items()})
        return
    say(node.full_name)
    for title, part in shown.items():
        say(f"  {title}:")
        lines = [f"    {name}: {', '.join(types)}" for name, types in part.items()]
        say(*(lines or [""]))
