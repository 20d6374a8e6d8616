"""Executable ros_gz_create: does what ros_gz_sim's `create` does, with the same arguments."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_control.manager.node_arguments import split_ros_arguments
from arm_gazebo.errors import GazeboError
from arm_node.parameter_values import ParameterValueError, read_text
from arm_node.process import EXIT_FAILED, EXIT_OK
from arm_node.task import run_task

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_node.process import NodeProcess

POSE = {"x": "x", "y": "y", "z": "z", "R": "roll", "P": "pitch", "Y": "yaw"}
WAIT_S = 0.1
RESULT_OK = 1


def main(argv: Sequence[str] | None = None) -> int:
    """Spawn the entity; return 0, or 1 if the simulation refuses, or 2 for invalid arguments."""
    program, *words = sys.argv if argv is None else argv
    own, ros = split_ros_arguments(words)
    options = parser().parse_args(own)
    if not (options.topic or options.file or options.string or options.param):
        parser().error("give what to create: -topic TOPIC, -file FILE, -string TEXT or -param NAME")

    def task(node: "Node", process: "NodeProcess") -> int:
        return create(node, process, options)

    return run_task("ros_gz_sim", task, [program, *ros], (GazeboError, ParameterValueError))


def parser() -> argparse.ArgumentParser:
    """Return the parser of `create`'s arguments."""
    made = argparse.ArgumentParser(
        prog="create",
        description="Spawn a robot or an object in the simulation. The first robot in a world that "
        "waits for one gets its controllers.",
        allow_abbrev=False,
    )
    made.add_argument("-world", "--world", default="", help="ignored: there is only one world")
    made.add_argument("-topic", "--topic", default="", help="topic of the description")
    made.add_argument("-file", "--file", default="", help="URDF or SDF file")
    made.add_argument("-string", "--string", default="", help="URDF or SDF text")
    made.add_argument("-param", "--param", default="", help="parameter of this node with the text")
    made.add_argument("-name", "--name", default="", help="name of the entity")
    made.add_argument(
        "-allow_renaming", "--allow_renaming", nargs="?", const="true", default="false"
    )
    for letter, what in POSE.items():
        made.add_argument(f"-{letter}", f"--{letter}", type=float, default=0.0, help=what)
    return made


def create(node: "Node", process: "NodeProcess", options: argparse.Namespace) -> int:
    """Request the entity from the simulation; return the exit code.

    Raises:
        GazeboError: the file does not exist.
    """
    from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
    from simulation_interfaces.msg import Resource
    from simulation_interfaces.srv import SpawnEntity

    from arm_description.transforms import quaternion_from_rpy

    text = description_of(node, process, options)
    if text is None:
        return EXIT_FAILED
    qx, qy, qz, qw = quaternion_from_rpy([options.R, options.P, options.Y]).tolist()
    request = SpawnEntity.Request(
        name=options.name,
        allow_renaming=options.allow_renaming.lower() in ("true", "1") or not options.name,
        entity_resource=Resource(resource_string=text),
        initial_pose=PoseStamped(
            pose=Pose(
                position=Point(x=options.x, y=options.y, z=options.z),
                orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
            )
        ),
    )
    client = node.create_client(SpawnEntity, "spawn_entity")
    while not client.service_is_ready():
        if process.wait(WAIT_S):
            return EXIT_FAILED
    future = client.call_async(request)
    node.get_logger().info("Requested creation of entity.")
    while not future.done():
        if process.wait(WAIT_S):
            return EXIT_FAILED
    answer: Any = future.result()
    result = answer.result
    if result.result != RESULT_OK:
        node.get_logger().error(f"Failed creation of entity: {result.error_message}")
        return EXIT_FAILED
    node.get_logger().info("Entity creation successful.")
    return EXIT_OK


def description_of(node: "Node", process: "NodeProcess", options: argparse.Namespace) -> str | None:
    """Return the description to spawn; None if the process ends before it arrives.

    Raises:
        GazeboError: the file does not exist.
    """
    if options.string:
        return options.string
    if options.param:
        from arm_node.parameters import declare

        return declare(node, options.param, "", read_text, "the description to spawn")
    if options.file:
        try:
            return Path(options.file.removeprefix("file://")).read_text(encoding="utf-8")
        except (OSError, UnicodeError) as error:
            raise GazeboError(f"{options.file} cannot be read: {error}") from error
    from std_msgs.msg import String

    from arm_node.qos import LATCHED

    texts: list[str] = []

    def take(message: Any) -> None:
        texts.append(message.data)

    node.create_subscription(String, options.topic, take, LATCHED)
    node.get_logger().info(f"Waiting messages on topic [{options.topic}].")
    while not texts:
        if process.wait(WAIT_S):
            return None
    return texts[0]


if __name__ == "__main__":
    sys.exit(main())
