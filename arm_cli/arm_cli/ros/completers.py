"""Completers of names on the running graph, for the Tab key."""

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_cli.ros.parameters import NodeParameters


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


def parameters(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the parameters of the typed node."""
    return _ask_node(parsed_args, lambda node: node.names())


def parameter_values(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return values of the typed parameter: true and false for a boolean, else its value."""

    def values(node: "NodeParameters") -> list[str]:
        from arm_cli.parameter_values import read_value

        (value,) = node.values([parsed_args.parameter_name])
        content = read_value(value)
        if isinstance(content, bool):
            return ["true", "false"]
        return [] if content is None else [content if isinstance(content, str) else repr(content)]

    return _ask_node(parsed_args, values)


def _ask_node(
    parsed_args: argparse.Namespace, ask: Callable[["NodeParameters"], list[str]]
) -> list[str]:
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import Graph
        from arm_cli.ros.parameters import NodeParameters

        node = Graph(session).find_node(parsed_args.node_name)
        return ask(NodeParameters(session, node, answer_timeout_s=1.0))


def _look(take: Callable[[Any], list[str]]) -> list[str]:
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import Graph, SettleTimes

        graph = Graph(session)
        # Tab must be fast, so it offers only what is discovered at once.
        graph.settle(SettleTimes(quiet_s=0.1, empty_s=0.15, settled_s=0.5))
        return take(graph)
