"""Services made from a table."""

from collections.abc import Callable, Iterable
from inspect import iscoroutinefunction
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

ServiceRow = tuple[Any, str, Callable[[Any, Any], Any]]
"""Type, name and what answers: it takes request and response, and returns the latter."""


def create_services(node: Node, rows: Iterable[ServiceRow]) -> None:
    """Create a service for each row; an answer may be a coroutine.

    A coroutine keeps the others of its callback group waiting until it ends: it has one of its own.
    """
    for type_, name, callback in rows:
        group = MutuallyExclusiveCallbackGroup() if iscoroutinefunction(callback) else None
        node.create_service(type_, name, callback, callback_group=group)
