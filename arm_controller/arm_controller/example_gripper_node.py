"""Executable example_gripper: closes the gripper of the demo, half opens it, and lets go."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_node.discovery import answers_held_back
from arm_node.process import EXIT_FAILED, EXIT_OK, NodeProcess, run_process

COMMANDS = (0.0, 0.38, 0.19, 0.0)
"""In m or N, as the gripper is commanded."""
PACE_S = 1.0


def main(argv: Sequence[str] | None = None) -> int:
    """Run until every command has had its turn; return 1 if nobody listens."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from std_msgs.msg import Float64MultiArray

    from arm_controller.ros.command_sequence import CommandSequence

    with answers_held_back():
        node = CommandSequence(
            "gripper_test_node",
            "gripper_controller/commands",
            Float64MultiArray,
            (Float64MultiArray(data=[command]) for command in COMMANDS),
            PACE_S,
            lambda published: process.stop(EXIT_OK if published else EXIT_FAILED),
        )
    process.executor.add_node(node)
    yield


if __name__ == "__main__":
    sys.exit(main())
