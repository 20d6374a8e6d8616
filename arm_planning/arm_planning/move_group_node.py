"""The executable move_group: plans and executes motions for MoveIt's clients."""

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
    from arm_planning.ros.move_group import MoveGroup
    from arm_planning.ros.robot_setup import planning_node, read_setup, scene_node

    node = first_node(lambda: planning_node("move_group"))
    setup = read_setup(node)
    private = scene_node()
    process.executor.add_node(private)
    group = MoveGroup(node, private, setup)
    with group.serving():
        node.get_logger().info("You can start planning now!")
        yield
    # What still runs uses its handles.
    node.destroy_node()


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    errors = (PlanningError, DescriptionError)
    return run_process(application, argv, user_errors=errors, packages=PLANNING_PACKAGES)


if __name__ == "__main__":
    sys.exit(main())
