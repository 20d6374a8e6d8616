"""Executable publisher_defined: moves the arm to the poses in a file, one after the other."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_controller.errors import ArmControllerError
from arm_node.process import NodeProcess, run_node

if TYPE_CHECKING:
    from rclpy.node import Node


def main(argv: Sequence[str] | None = None) -> int:
    """Run until all poses are done; return 1 if one of them was not reached."""
    return run_node(_make_node, argv, user_errors=(ArmControllerError,))


def _make_node(process: NodeProcess) -> "Node":
    from arm_controller.ros.publisher_defined import PublisherDefined

    return PublisherDefined(process)


if __name__ == "__main__":
    sys.exit(main())
