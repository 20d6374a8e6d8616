"""The executable get_planning_scene_server: what a depth camera sees as objects of a scene."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_node.environment import SEEING_PACKAGES
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node
from arm_planning.errors import PerceptionError

NAME = "get_planning_scene_server"


@contextmanager
def application(process: NodeProcess) -> Iterator[None]:
    """Serve until the process ends."""
    # Imported only after the environment is prepared, because it locates the message packages.
    from rclpy.node import Node

    from arm_planning.ros.table_server import TableServer

    node = first_node(lambda: Node(NAME, allow_undeclared_parameters=True))
    server = TableServer(node, process.wait)
    process.executor.add_node(node)
    yield
    del server


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    return run_process(application, argv, (PerceptionError,), SEEING_PACKAGES)


if __name__ == "__main__":
    sys.exit(main())
