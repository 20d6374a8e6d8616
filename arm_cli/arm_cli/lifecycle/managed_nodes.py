"""The nodes that have a lifecycle: those that serve `get_state`."""

import argparse
from typing import TYPE_CHECKING

from arm_cli.errors import NotFoundError
from arm_cli.ros import completers
from arm_cli.word_completion import complete_with
from launch_py.near_names import describe_known

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph, NodeName

STATE_TYPE = "lifecycle_msgs/srv/GetState"


def add_node_argument(parser: argparse.ArgumentParser) -> None:
    """Add the name of one managed node."""
    complete_with(
        parser.add_argument("node_name", help="one that `arm lifecycle nodes` lists"),
        completers.nodes,
    )
    # A node that is named may always be a hidden one; but lines written for ros2 say so.
    parser.add_argument("--include-hidden-nodes", action="store_true", help=argparse.SUPPRESS)


def managed_nodes(graph: "Graph", hidden: bool = False) -> "list[NodeName]":
    """Return the nodes with a lifecycle, once the graph has settled."""
    graph.settle()
    services = graph.services(hidden=True)
    return [
        node
        for node in graph.nodes(hidden)
        if STATE_TYPE in services.get(f"{node.full_name}/get_state", [])
    ]


def managed_node(graph: "Graph", name: str) -> "NodeName":
    """Return the node of a name.

    Raises:
        NotFoundError: there is no such node, or it has no lifecycle.
    """
    node = graph.find_node(name)
    managed = managed_nodes(graph, hidden=True)
    if node not in managed:
        hint = describe_known(node.full_name, (n.full_name for n in managed), "those that have:")
        raise NotFoundError(f"{node.full_name} has no lifecycle; {hint}")
    return node
