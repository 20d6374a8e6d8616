"""The executable servo_node: jogs a robot for moveit_servo's clients."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_node.environment import PLANNING_PACKAGES
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node
from arm_planning.errors import PlanningError


@contextmanager
def application(process: NodeProcess) -> Iterator[None]:
    """Serve until the process ends."""
    # Imported only after the environment is prepared, because it locates the message packages.
    from arm_planning.ros.robot_setup import planning_node, read_setup
    from arm_planning.ros.servo import JogServer, read_servo_settings

    node = first_node(lambda: planning_node("servo_node"))
    settings = read_servo_settings(node)
    servo = JogServer(node, read_setup(node), settings)
    process.executor.add_node(node)
    servo.begin()
    yield


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    errors = (PlanningError, DescriptionError)
    return run_process(application, argv, user_errors=errors, packages=PLANNING_PACKAGES)


if __name__ == "__main__":
    sys.exit(main())
