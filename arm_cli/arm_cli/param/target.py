"""The node whose parameters a verb is about."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_cli.ros import completers
from arm_cli.ros.connection import connect
from arm_cli.word_completion import complete_with

if TYPE_CHECKING:
    from arm_cli.ros.parameters import NodeParameters


def add_node_argument(parser: argparse.ArgumentParser) -> None:
    """Add the node's name."""
    complete_with(
        parser.add_argument("node_name", help="such as /arm_controller_node"), completers.nodes
    )
    # A node that is named may always be a hidden one; but lines written for ros2 say so.
    parser.add_argument("--include-hidden-nodes", action="store_true", help=argparse.SUPPRESS)


@contextmanager
def open_parameters(node_name: str) -> Iterator["NodeParameters"]:
    """Give the parameters of a node.

    Raises:
        NotFoundError: there is no such node.
    """
    with connect() as session:
        from arm_cli.ros.graph import Graph
        from arm_cli.ros.parameters import NodeParameters

        yield NodeParameters(session, Graph(session).find_node(node_name))
