"""Executable ros_gz_bridge: accepts the arguments of ros_gz_bridge's and ros_gz_image's programs.

The simulation's topics already are ROS topics, so there is nothing to bridge. Messages are relayed
only if the arguments give a topic another name in ROS.
"""

import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_control.manager.node_arguments import split_ros_arguments
from arm_gazebo.errors import GazeboError
from arm_node.parameter_values import ParameterValueError, read_text
from arm_node.task import run_task

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_node.process import NodeProcess

BRIDGE = re.compile(r"([^@\[\]]+)@([\w/]+)([@\[\]])([\w.]+)")
"""/topic@ros/msg/Type@gz.msgs.Type; [ is from Gazebo to ROS, ] the other way, @ both."""
TO_GAZEBO = "]"
DIRECTIONS = {"GZ_TO_ROS": "[", "ROS_TO_GZ": TO_GAZEBO, "BIDIRECTIONAL": "@"}
IMAGE = "sensor_msgs/msg/Image"
HINT = "it is /topic@ros_package/msg/Type@gz.msgs.Type"


@dataclass(frozen=True, slots=True)
class Bridged:
    """A topic with its names in the simulation and in ROS; `to_gazebo` is its direction."""

    gazebo: str
    ros: str
    type: str
    to_gazebo: bool = False


def main(argv: Sequence[str] | None = None) -> int:
    """Run until told to stop; return the exit code."""
    program, *words = sys.argv if argv is None else argv
    own, ros = split_ros_arguments(words)

    def task(node: "Node", process: "NodeProcess") -> int:
        from arm_node.parameters import declare

        file = declare(node, "config_file", "", read_text, "YAML file with the topics to bridge")
        topics = [parse(word) for word in own if not word.startswith("-")]
        bridge(node, process, [*topics, *(read_config(Path(file)) if file else ())])
        return 0

    return run_task("ros_gz_bridge", task, [program, *ros], (GazeboError, ParameterValueError))


def parse(word: str) -> Bridged:
    """Return the topic that an argument of parameter_bridge or image_bridge names.

    Raises:
        GazeboError: the argument is invalid.
    """
    if "@" not in word:
        return Bridged(word, word, IMAGE)
    match = BRIDGE.fullmatch(word)
    if match is None:
        raise GazeboError(f"{word!r} is not a bridge; {HINT}")
    return Bridged(match[1], match[1], match[2], match[3] == TO_GAZEBO)


def read_config(path: Path) -> list[Bridged]:
    """Return the topics that a YAML file of ros_gz_bridge names.

    Raises:
        GazeboError: the file cannot be read, or an entry lacks a name or a type.
    """
    from arm_gazebo.launching.settings_file import parse_yaml, read_text

    title = "the bridge's file"
    entries = parse_yaml(read_text(path, title), path, title)
    if not isinstance(entries, list):
        raise GazeboError(f"{title} {path} is not a list of topics")
    return [_entry(entry, f"{title} {path}") for entry in entries]


def _entry(entry: Any, where: str) -> Bridged:
    words: dict[str, Any] = entry if isinstance(entry, dict) else {}
    name = words.get("topic_name")
    gazebo, ros = words.get("gz_topic_name", name), words.get("ros_topic_name", name)
    kind, direction = words.get("ros_type_name"), words.get("direction", "BIDIRECTIONAL")
    if not (gazebo or ros) or not kind or direction not in DIRECTIONS:
        raise GazeboError(
            f"{where}: {entry!r} needs ros_topic_name or gz_topic_name, ros_type_name, and a "
            f"direction of {', '.join(DIRECTIONS)} or none"
        )
    to_gazebo = DIRECTIONS[direction] == TO_GAZEBO
    return Bridged(str(gazebo or ros), str(ros or gazebo), str(kind), to_gazebo)


def bridge(node: "Node", process: "NodeProcess", topics: Sequence[Bridged]) -> None:
    """Relay messages between different names until the process ends.

    Raises:
        GazeboError: a message type does not exist.
    """
    from rclpy.node import Node

    # A remapping of this process renames the ROS side only.
    inside = Node("ros_gz_bridge_inside", use_global_arguments=False)
    process.executor.add_node(inside)
    for topic in topics:
        ros, gazebo = node.resolve_topic_name(topic.ros), inside.resolve_topic_name(topic.gazebo)
        if ros == gazebo:
            node.get_logger().info(f"{ros} is a ROS topic already")
            continue
        class_ = _message_class(topic.type)
        source, sink = (node, inside) if topic.to_gazebo else (inside, node)
        names = (topic.ros, topic.gazebo) if topic.to_gazebo else (topic.gazebo, topic.ros)
        publisher = sink.create_publisher(class_, names[1], 10)
        source.create_subscription(class_, names[0], publisher.publish, 10, raw=True)
        node.get_logger().info(
            f"passing {gazebo if sink is node else ros} on as {ros if sink is node else gazebo}"
        )
    process.wait()


def _message_class(name: str) -> Any:
    package, _, kind = name.replace("/msg/", "/").partition("/")
    try:
        return getattr(import_module(f"{package}.msg"), kind)
    except (AttributeError, ImportError) as error:
        raise GazeboError(f"no message type {name!r}") from error


if __name__ == "__main__":
    sys.exit(main())
