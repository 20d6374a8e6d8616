"""Completers of names on the running graph, for the Tab key.

Names come from a running robot's process if there is one, which takes no time; see
`arm_node.graph_names`. Otherwise they are discovered, which takes half a second.
"""

import argparse
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from arm_cli.names import absolute_name, is_hidden
from arm_node.graph_names import GraphNames, ask_for_names

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
    return _names(lambda known: known.topics, lambda graph: list(graph.topics()))


def nodes(**_: Any) -> list[str]:
    """Return the nodes."""
    return _names(
        lambda known: known.nodes, lambda graph: [node.full_name for node in graph.nodes()]
    )


def services(**_: Any) -> list[str]:
    """Return the services."""
    return _names(lambda known: known.services, lambda graph: list(graph.services()))


def actions(**_: Any) -> list[str]:
    """Return the actions."""
    return _names(lambda known: known.actions, lambda graph: list(graph.actions()))


def parameters(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return the parameters of the typed node."""
    return _ask_node(parsed_args, lambda node: node.names())


def parameter_values(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Return values of the typed parameter: true and false for a boolean, else its value."""

    def values(node: "NodeParameters") -> list[str]:
        from arm_cli.ros.parameters import read_value

        (value,) = node.values([parsed_args.parameter_name])
        content = read_value(value)
        if isinstance(content, bool):
            return ["true", "false"]
        return [] if content is None else [content if isinstance(content, str) else repr(content)]

    return _ask_node(parsed_args, values)


def _ask_node(
    parsed_args: argparse.Namespace, ask: Callable[["NodeParameters"], list[str]]
) -> list[str]:
    known = ask_for_names(os.environ)
    if known is not None and absolute_name(parsed_args.node_name) not in known.nodes:
        return []
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import NodeName
        from arm_cli.ros.parameters import NodeParameters

        # The services of a node are discovered before its name, which need not be awaited.
        node = NodeName.of(parsed_args.node_name)
        return ask(NodeParameters(session, node, ANSWER_TIMEOUT_S, SERVER_TIMEOUT_S))


def _names(
    told: Callable[[GraphNames], list[str]], discovered: Callable[["Graph"], list[str]]
) -> list[str]:
    known = ask_for_names(os.environ)
    if known is not None:
        return [name for name in told(known) if not is_hidden(name)]
    return _discover(discovered)


def _discover(take: Callable[["Graph"], list[str]]) -> list[str]:
    from arm_cli.ros.connection import connect

    with connect() as session:
        from arm_cli.ros.graph import Graph, SettleTimes

        graph = Graph(session)
        # Tab must be fast, so it does not wait for latecomers; but the first answers of the others
        # take 0.1 to 0.3 s.
        graph.settle(SettleTimes(quiet_s=0.1, empty_s=EMPTY_S, settled_s=0.5))
        return take(graph)
