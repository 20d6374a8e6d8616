"""Executable arm_controller_node: moves the arm to the pose in a parameter, prints its state."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_controller.errors import ArmControllerError
from arm_node.process import NodeProcess, run_node

if TYPE_CHECKING:
    from rclpy.node import Node


def main(argv: Sequence[str] | None = None) -> int:
    """Run the node until a signal ends it; return the exit code."""
    return run_node(_make_node, argv, user_errors=(ArmControllerError,))


def _make_node(_process: NodeProcess) -> "Node":
    from arm_controller.ros.arm_controller import ArmController

    return ArmController()


if __name__ == "__main__":
    sys.exit(main())
