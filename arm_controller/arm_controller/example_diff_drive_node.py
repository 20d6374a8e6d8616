"""Executable example_diff_drive: drives a two-wheeled robot in circles until it is stopped."""

import sys
from collections.abc import Sequence
from itertools import repeat
from typing import TYPE_CHECKING

from arm_controller.errors import ArmControllerError
from arm_node.process import NodeProcess, run_node

if TYPE_CHECKING:
    from rclpy.node import Node

FORWARDS_M_S = 0.1
TO_THE_LEFT_RAD_S = 0.1
PACE_S = 0.05


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal ends it; return 1 if there is no subscriber."""
    return run_node(_make_node, argv, user_errors=(ArmControllerError,))


def _make_node(process: NodeProcess) -> "Node":
    from geometry_msgs.msg import TwistStamped

    from arm_controller.ros.command_sequence import CommandSequence

    # Without a stamp the command counts as new, even if the controller uses simulation time.
    command = TwistStamped()
    command.twist.linear.x = FORWARDS_M_S
    command.twist.angular.z = TO_THE_LEFT_RAD_S
    return CommandSequence(
        process,
        "diff_drive_test_node",
        "diff_drive_base_controller/cmd_vel",
        TwistStamped,
        repeat(command),
        PACE_S,
    )


if __name__ == "__main__":
    sys.exit(main())
