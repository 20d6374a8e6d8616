"""Executable arm_gripper_loop_controller: moves an arm and its gripper to and fro until Ctrl-C."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_node.discovery import answers_held_back
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run until the end is asked for; return the exit code."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.arm_gripper_loop import ArmGripperLoop
    from arm_controller.ros.arm_gripper_loop_controller import ArmGripperLoopController

    with answers_held_back():
        node = ArmGripperLoopController()
    process.executor.add_node(node)
    process.executor.create_task(ArmGripperLoop(node).run_for_ever)
    yield
    node.stop()


if __name__ == "__main__":
    sys.exit(main())
