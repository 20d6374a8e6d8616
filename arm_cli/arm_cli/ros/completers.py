"""Completers of names on the running graph, for the Tab key."""

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph
    from arm_cli.ros.parameters import NodeParameters

EMPTY_S = 0.35
"""If no other node has been found for this long, there is none."""
ANSWER_TIMEOUT_S = 1.0
SERVER_TIMEOUT_S = 1.0
"""A node whose parameter services have not been discovered by then does not exist."""


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
        from arm_cli.ros.graph import NodeName
        from arm_cli.ros.parameters import NodeParameters

        # The services of a node are discovered before its name, which need not be awaited.
        node = NodeName.of(parsed_args.node_name)
        return ask(NodeParameters(session, node, ANSWER_TIMEOUT_S, SERVER_TIMEOUT_S))


def _look(take: Callable[["Graph"], list[str]]) -> list[str]:
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import Graph, SettleTimes

        graph = Graph(session)
        # Tab must be fast, so it does not wait for latecomers; but the first answers of the others
        # take 0.1 to 0.3 s.
        graph.settle(SettleTimes(quiet_s=0.1, empty_s=EMPTY_S, settled_s=0.5))
        return take(graph)
