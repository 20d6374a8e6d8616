"""Which topics of a bag become which features of a dataset."""

import argparse
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Group, positive_whole_number
from arm_cli.errors import BagError

if TYPE_CHECKING:
    from arm_cli.bag_format.topic import BagTopic

JOINT_STATE = "sensor_msgs/msg/JointState"
COMMANDS = "std_msgs/msg/Float64MultiArray"
CONTROLLER_STATE = "control_msgs/msg/JointTrajectoryControllerState"
ACTIONS = (COMMANDS, CONTROLLER_STATE, JOINT_STATE)
IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
STATES = "/joint_states"
STATE_FIELDS = ("position", "velocity", "effort")


@dataclass(frozen=True, slots=True)
class DatasetOptions:
    """The user's choice of topics, fields and rate.

    Attributes:
        state: topic of the states; None to find it.
        fields: fields of the joints that are states.
        action: topic of the actions; None to find it.
        cameras: topics of images by the names of their features; None for all.
        fps: rows per second; None for the rate of the first camera, or of the states.
    """

    state: str | None
    fields: tuple[str, ...]
    action: str | None
    cameras: tuple[str, ...] | None
    fps: int | None


@dataclass(frozen=True, slots=True)
class ChosenTopics:
    """The topics of one bag that become features; those of cameras by the names of the features."""

    state: "BagTopic"
    action: "BagTopic"
    cameras: "Mapping[str, BagTopic]"


TOPICS = Group(
    "topics",
    Argument("--state", metavar="TOPIC", help=f"joint states (default {STATES})"),
    Argument(
        "--state-fields",
        nargs="+",
        choices=STATE_FIELDS,
        default=[STATE_FIELDS[0]],
        help="fields of the joints that form the state (default position)",
    ),
    Argument(
        "--action",
        metavar="TOPIC",
        help="commands: Float64MultiArray, JointState, or a trajectory controller's state, whose "
        "reference positions count (default: the only such topic with messages)",
    ),
    Argument(
        "--cameras",
        nargs="*",
        metavar="TOPIC",
        help="topics with colour images (default: all that are not compressed)",
    ),
    Argument(
        "--fps",
        type=positive_whole_number,
        metavar="N",
        help="rows per second (default: the rate of the first camera, or else of the states)",
    ),
)
"""The options that say which topics become what."""


def dataset_options(options: argparse.Namespace) -> DatasetOptions:
    """Return the parsed options."""
    cameras = None if options.cameras is None else tuple(options.cameras)
    return DatasetOptions(
        options.state, tuple(options.state_fields), options.action, cameras, options.fps
    )


def choose_topics(wanted: DatasetOptions, topics: "Mapping[BagTopic, int]") -> ChosenTopics:
    """Choose among a bag's topics, each with its number of messages.

    Raises:
        BagError: a topic is missing, or it is not clear which one is meant.
    """
    filled = {topic.name: topic for topic, count in topics.items() if count}
    state = _named(wanted.state or STATES, filled, (JOINT_STATE,), "--state")
    if wanted.action is not None:
        action = _named(wanted.action, filled, ACTIONS, "--action")
    else:
        action = _only_action(filled)
    if wanted.cameras is None:
        cameras = [topic for topic in filled.values() if topic.type == IMAGE]
    else:
        cameras = [
            _named(name, filled, (IMAGE, COMPRESSED), "--cameras") for name in wanted.cameras
        ]
    return ChosenTopics(state, action, {_camera_name(topic.name): topic for topic in cameras})


def _named(
    name: str, topics: "Mapping[str, BagTopic]", types: tuple[str, ...], option: str
) -> "BagTopic":
    topic = topics.get(name if name.startswith("/") else f"/{name}")
    fitting = [one.name for one in topics.values() if one.type in types]
    if topic is None or topic.type not in types:
        why = "has no messages of" if topic is None else f"has {topic.type} on"
        raise BagError(f"the bag {why} {name}; {option} can be {', '.join(fitting) or 'nothing'}")
    return topic


def _only_action(topics: "Mapping[str, BagTopic]") -> "BagTopic":
    for kind in (COMMANDS, CONTROLLER_STATE):
        found = [topic for topic in topics.values() if topic.type == kind]
        if len(found) == 1:
            return found[0]
        if found:
            names = ", ".join(topic.name for topic in found)
            raise BagError(
                f"several topics could be the actions; choose one with --action: {names}"
            )
    raise BagError(
        "no topic with messages is a command: the bag has no Float64MultiArray and no state of a "
        "trajectory controller"
    )


def _camera_name(topic: str) -> str:
    """Return "camera" for /camera/image_raw, and "arm_camera" for /arm/camera/image_raw."""
    parts = [part for part in topic.split("/") if part]
    return "_".join(parts[:-1] or parts)
