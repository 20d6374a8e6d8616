"""Executable example_diff_drive: drives the robot on two wheels in circles, until it is stopped."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import repeat

from arm_controller.errors import ArmControllerError
from arm_node.discovery import answers_held_back
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess, run_process

FORWARDS_M_S = 0.1
TO_THE_LEFT_RAD_S = 0.1
PACE_S = 0.05


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal; return 1 if nobody listens."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from geometry_msgs.msg import TwistStamped

    from arm_controller.ros.command_sequence import CommandSequence

    # Without a stamp: the controller's clock may be a simulation's, and then it counts as now.
    command = TwistStamped()
    command.twist.linear.x = FORWARDS_M_S
    command.twist.angular.z = TO_THE_LEFT_RAD_S
    with answers_held_back():
        node = CommandSequence(
            "diff_drive_test_node",
            "diff_drive_base_controller/cmd_vel",
            TwistStamped,
            repeat(command),
            PACE_S,
            lambda published: process.stop(EXIT_OK if published else EXIT_FAILED),
        )
    process.executor.add_node(node)
    yield


if __name__ == "__main__":
    sys.exit(main())
