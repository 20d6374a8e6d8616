"""Executable example_gripper: closes the demo's gripper, opens it halfway, and releases it."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_controller.errors import ArmControllerError
from arm_node.process import NodeProcess, run_node

if TYPE_CHECKING:
    from rclpy.node import Node

COMMANDS = (0.0, 0.38, 0.19, 0.0)
"""In m or N, depending on the gripper's command interface."""
PACE_S = 1.0


def main(argv: Sequence[str] | None = None) -> int:
    """Run until every command has been sent; return 1 if there is no subscriber."""
    return run_node(_make_node, argv, user_errors=(ArmControllerError,))


def _make_node(process: NodeProcess) -> "Node":
    from std_msgs.msg import Float64MultiArray

    from arm_controller.ros.command_sequence import CommandSequence

    return CommandSequence(
        process,
        "gripper_test_node",
        "gripper_controller/commands",
        Float64MultiArray,
        (Float64MultiArray(data=[command]) for command in COMMANDS),
        PACE_S,
    )


if __name__ == "__main__":
    sys.exit(main())
