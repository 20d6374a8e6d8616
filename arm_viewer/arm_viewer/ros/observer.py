"""The base of every observer of topics or services, and shared look-ups of topic types."""

from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from typing import Any, Protocol, TypeVar

from rclpy.node import Node
from rclpy.subscription import Subscription

TopicTypes = Mapping[str, Sequence[str]]
"""The types of every topic in the graph, by name."""

_OF_RCL = {"/rosout": "rcl_interfaces/msg/Log"}
"""Endpoints that rcl makes for every node, which rclpy does not list."""


class Observer:
    """Observes one aspect of the graph; used only in the executor's thread.

    Each observer offers its findings as frozen data in an attribute. The node combines them in a
    snapshot.
    """

    def discover(self, topics: TopicTypes) -> None:
        """Look for new and disappeared topics or services; called once a second."""

    def collect(self, now_s: float) -> None:
        """Take the messages that have arrived since the last call; called 30 times a second."""


class Closable(Protocol):
    """Something with end points on the graph."""

    def close(self) -> None:
        """Destroy them."""
        ...


Key = TypeVar("Key", bound=Hashable)
Kept = TypeVar("Kept", bound=Closable)


def keep_in_step(
    kept: dict[Key, Kept], wanted: Collection[Key], make: Callable[[Key], Kept]
) -> None:
    """Close and drop what is not wanted any more, and make what is wanted and not there yet."""
    for key in [key for key in kept if key not in wanted]:
        kept.pop(key).close()
    for key in wanted:
        if key not in kept:
            kept[key] = make(key)


def type_name(message_class: type) -> str:
    """Return the type name of a message class in the graph, such as "std_msgs/msg/String"."""
    package, kind = message_class.__module__.split(".")[:2]
    return f"{package}/{kind}/{message_class.__name__}"


def used_types(node: Node, excluded: Collection[Subscription] = ()) -> dict[str, str]:
    """Return the types of the topics on which a node has endpoints, without excluded ones."""
    ends: list[Any] = [*node.publishers, *(s for s in node.subscriptions if s not in excluded)]
    return _OF_RCL | {end.topic_name: type_name(end.msg_type) for end in ends}


def topics_of(message_class: type, topics: TopicTypes, node: Node) -> set[str]:
    """Return the topics that have this type and that the node does not use with another type."""
    wanted, used = type_name(message_class), used_types(node)
    return {
        topic
        for topic, types in topics.items()
        if wanted in types and used.get(topic, wanted) == wanted
    }


def served(node: Node, suffix: str, service_type: str) -> set[str]:
    """Return what stands before a suffix in the names of services of a type that have servers.

    The graph also lists services that only have clients, such as the page's own.
    """
    return {
        service.removesuffix(suffix)
        for service, types in node.get_service_names_and_types()
        if service.endswith(suffix) and service_type in types and node.count_services(service)
    }
