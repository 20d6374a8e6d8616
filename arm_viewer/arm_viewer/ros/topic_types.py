"""The types of topics, of which a process can have one alone on each.

The middleware refuses an end point of a second type on a topic that the process has already,
whatever others publish there.
"""

from collections.abc import Collection
from typing import Any

from rclpy.node import Node
from rclpy.subscription import Subscription

from arm_viewer.ros.observer import TopicTypes

_BY_ITSELF = {"/rosout": "rcl_interfaces/msg/Log"}
"""What rcl makes for every node, which rclpy does not list."""


def type_name(message_class: type) -> str:
    """Return the name that ROS's graph has for a message class: "std_msgs/msg/String"."""
    package, kind = message_class.__module__.split(".")[:2]
    return f"{package}/{kind}/{message_class.__name__}"


def used_types(node: Node, besides: Collection[Subscription] = ()) -> dict[str, str]:
    """Return the type of every topic on which a node has end points, besides some of them."""
    ends: list[Any] = [*node.publishers, *(s for s in node.subscriptions if s not in besides)]
    return _BY_ITSELF | {end.topic_name: type_name(end.msg_type) for end in ends}


def topics_of(message_class: type, topics: TopicTypes, node: Node) -> set[str]:
    """Return the topics that are known to have this type, and that a node can have by it."""
    wanted, used = type_name(message_class), used_types(node)
    return {
        topic
        for topic, types in topics.items()
        if wanted in types and used.get(topic, wanted) == wanted
    }
