"""The executable robot_state_publisher: /tf, /tf_static and /robot_description of robots."""

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from arm_description.errors import DescriptionError
from arm_node.graph_names import telling_names
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node

if TYPE_CHECKING:
    from arm_description.publishers.ros_robot_state_publisher import RobotStatePublisher


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    arguments = list(sys.argv if argv is None else argv)

    @contextmanager
    def application(_process: NodeProcess) -> Iterator[None]:
        from rclpy.utilities import remove_ros_args

        from arm_description.publishers.ros_robot_state_publisher import spinning

        # Other words are ignored, as by ROS 2's program.
        known, _ = _parser().parse_known_args(remove_ros_args(arguments)[1:])
        nodes = first_node(lambda: _nodes(known.namespaces, known.urdf), _destroy)
        with spinning(*nodes), telling_names(nodes[0]):
            yield

    return run_process(application, arguments, user_errors=(DescriptionError,))


def _nodes(namespaces: Sequence[str], urdf: str | None) -> "list[RobotStatePublisher]":
    """Return a node for each namespace; if one cannot be made, none of them stays."""
    from arm_description.publishers.ros_robot_state_publisher import RobotStatePublisher

    with ExitStack() as made:
        nodes: list[RobotStatePublisher] = []
        for namespace in namespaces:
            nodes.append(RobotStatePublisher(namespace, urdf))
            made.callback(nodes[-1].destroy_node)
        made.pop_all()
    return nodes


def _destroy(nodes: "Sequence[RobotStatePublisher]") -> None:
    for node in nodes:
        node.destroy_node()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="robot_state_publisher",
        description="Publish the transforms of a robot's links from its joint states. Parameters "
        "and topics are those of the ROS 2 node of the same name.",
    )
    parser.add_argument(
        "urdf",
        nargs="?",
        help="a URDF file, where the parameter robot_description is empty (deprecated by ROS)",
    )
    parser.add_argument(
        "--namespaces",
        nargs="+",
        default=[""],
        metavar="NAMESPACE",
        help="make a node in each of these namespaces, one for each robot of a world",
    )
    return parser


if __name__ == "__main__":
    sys.exit(main())
