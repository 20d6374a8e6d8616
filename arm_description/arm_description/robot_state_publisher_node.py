"""The executable robot_state_publisher: /tf, /tf_static and /robot_description of a robot."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import prompt_discovery


@contextmanager
def application(_process: NodeProcess) -> Iterator[None]:
    """Run the node."""
    from arm_description.publishers.ros_robot_state_publisher import RobotStatePublisher, spinning

    with prompt_discovery():
        node = RobotStatePublisher()
    with spinning(node):
        yield


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    return run_process(application, argv, user_errors=(DescriptionError,))


if __name__ == "__main__":
    sys.exit(main())
