"""Offer a topic of every message type that is named as an argument."""

import importlib
import sys

import peer
from rclpy.node import Node


def create(node: Node) -> None:
    """Name each topic after its type."""
    for type_name in sys.argv[1:]:
        package, kind, class_name = type_name.split("/")
        message_type = getattr(importlib.import_module(f"{package}.{kind}"), class_name)
        node.create_publisher(message_type, f"/{type_name}", 1)


if __name__ == "__main__":
    peer.run("announcer", create)
