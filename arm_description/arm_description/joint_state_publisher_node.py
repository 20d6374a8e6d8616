"""The executable joint_state_publisher: joint states without a robot, from a URDF's joints."""

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_description.xacro_expansion import expand_xacro
from arm_node.process import NodeProcess, run_process


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    arguments = list(sys.argv if argv is None else argv)

    @contextmanager
    def application(process: NodeProcess) -> Iterator[None]:
        from rclpy.utilities import remove_ros_args

        from arm_description.ros.joint_state_publisher import JointStatePublisher

        file = _parser().parse_args(remove_ros_args(arguments)[1:]).urdf
        description = None if file is None else expand_xacro(file)
        node = JointStatePublisher(description, fail=lambda: process.stop(1))
        process.executor.add_node(node)
        yield

    return run_process(application, arguments, user_errors=(DescriptionError,))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="joint_state_publisher",
        description="Publish joint_states of a robot that is not there. Parameters and topics as "
        "the ROS 2 node of that name has them.",
    )
    parser.add_argument(
        "urdf",
        nargs="?",
        help="a URDF or xacro file; without it, the topic robot_description gives the robot",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
