"""Services made from a table."""

from collections.abc import Callable, Iterable
from typing import Any

from rclpy.node import Node

ServiceRow = tuple[Any, str, Callable[[Any, Any], Any]]
"""Type, name and what answers: it takes request and response, and returns the latter."""


def create_services(node: Node, rows: Iterable[ServiceRow]) -> None:
    """Create a service for each row; an answer may be a coroutine."""
    for type_, name, callback in rows:
        node.create_service(type_, name, callback)
