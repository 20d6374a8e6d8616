"""Executable arm_gripper_loop_controller: moves an arm and its gripper back and forth."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_controller.errors import ArmControllerError
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal ends it; return the exit code."""
    return run_process(_application, argv, user_errors=(ArmControllerError,))


@contextmanager
def _application(process: NodeProcess) -> Iterator[None]:
    from arm_controller.arm_gripper_loop import run_for_ever
    from arm_controller.ros.arm_gripper_loop_controller import ArmGripperLoopController

    node = first_node(ArmGripperLoopController)
    process.executor.add_node(node)
    process.executor.create_task(run_for_ever, node)
    yield
    node.stop()


if __name__ == "__main__":
    sys.exit(main())
