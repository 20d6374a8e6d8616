"""What the Tab key offers of the running graph."""

from collections.abc import Callable
from typing import Any


def topics(**_: Any) -> list[str]:
    """Return the topics."""
    return _look(lambda graph: list(graph.topics()))


def nodes(**_: Any) -> list[str]:
    """Return the nodes."""
    return _look(lambda graph: [node.full_name for node in graph.nodes()])


def services(**_: Any) -> list[str]:
    """Return the services."""
    return _look(lambda graph: list(graph.services()))


def actions(**_: Any) -> list[str]:
    """Return the actions."""
    return _look(lambda graph: list(graph.actions()))


def _look(take: Callable[[Any], list[str]]) -> list[str]:
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        return take(graph)
