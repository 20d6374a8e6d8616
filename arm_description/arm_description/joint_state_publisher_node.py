"""The executable joint_state_publisher: publishes joint states for the joints of a URDF."""

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_description.xacro.expansion import expand_xacro
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    arguments = list(sys.argv if argv is None else argv)

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.utilities import remove_ros_args

        from arm_description.publishers.ros_joint_state_publisher import JointStatePublisher

        file = _parser().parse_args(remove_ros_args(arguments)[1:]).urdf
        description = None if file is None else expand_xacro(file)
        node = JointStatePublisher(description, fail=lambda: process.stop(1))
        process.executor.add_node(node)
        yield

    return run_process(application, arguments, user_errors=(DescriptionError,))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="joint_state_publisher",
        description="Publish joint_states without a robot. Parameters and topics are those of the "
        "ROS 2 node of the same name.",
    )
    parser.add_argument(
        "urdf",
        nargs="?",
        help="a URDF, xacro, SDF or COLLADA file; without it, the robot comes from the topic "
        "robot_description",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
