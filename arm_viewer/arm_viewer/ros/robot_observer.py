"""Observe robots: descriptions, on robot_description in any namespace, and frames on /tf."""

import math
import time
from types import MappingProxyType

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from arm_description.errors import DescriptionError
from arm_description.resources import ResourceFinder
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import LATCHED
from arm_node.rigid_transform import RigidTransform
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.topic_reader import TopicGroup, TopicReader
from arm_viewer.snapshot import Description, Transform, frame_name

DESCRIPTION_WORD = "robot_description"


class DescriptionObserver(Observer):
    """Keeps the latest description of every published topic.

    Attributes:
        descriptions: descriptions by topic.
        lost: topics that no longer have a description.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe in the root namespace."""
        self._topics = TopicGroup(node, polled, String, DESCRIPTION_WORD, LATCHED)
        self._received_s: dict[str, float] = {}
        self.descriptions: MappingProxyType[str, Description] = MappingProxyType({})
        self.lost: frozenset[str] = frozenset()

    def discover(self, topics: TopicTypes) -> None:
        """Subscribe to new topics."""
        self._topics.discover(topics)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        for reader in self._topics.readers():
            topic, message = reader.topic, reader.take_newest()
            if message is not None:
                self._received_s[topic] = now_s
                self._keep({**self.descriptions, topic: described(topic, message.data)})
            elif self._received_s.get(topic, math.inf) < reader.outdated_before(now_s):
                del self._received_s[topic]
                self._keep({t: d for t, d in self.descriptions.items() if t != topic})

    def _keep(self, descriptions: dict[str, Description]) -> None:
        self.lost = (self.lost | self.descriptions.keys()) - descriptions.keys()
        self.descriptions = MappingProxyType(descriptions)


def described(topic: str, text: str) -> Description:
    """Return the robot of a description topic, or why its text is not a robot."""
    namespace = topic.removesuffix(f"/{DESCRIPTION_WORD}")
    try:
        # The text may name the folders of its meshes, so each robot needs its own finder.
        description = RobotDescription(text)
        robot = ResourceFinder.of_description(text).located(parse_urdf(description))
        return Description(topic, namespace, robot, initial=description.initial_values())
    except DescriptionError as error:
        return Description(topic, namespace, None, f"{topic} is not a valid robot: {error}")


_TF_QOS = QoSProfile(depth=100)
_STATIC_QOS = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformObserver(Observer):
    """Keeps the latest transform of every published frame."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe to both topics."""
        self._topics = (
            TopicReader(node, polled, TFMessage, "/tf_static", _STATIC_QOS),
            TopicReader(node, polled, TFMessage, "/tf", _TF_QOS),
        )
        self._received_s: tuple[dict[str, float], ...] = ({}, {})
        self.transforms: MappingProxyType[str, Transform] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Check whether a publisher has disappeared."""
        now_s = time.monotonic()
        for reader in self._topics:
            reader.look_for_publishers(now_s)

    def expect_again(self, now_s: float) -> None:
        """Forget the frames that are not published again soon."""
        for reader in self._topics:
            reader.look_for_publishers(now_s)
            reader.expect_again(now_s)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, and forget what is outdated."""
        new: dict[str, Transform] = {}
        outdated: set[str] = set()
        for reader, received_s in zip(self._topics, self._received_s, strict=True):
            for message in reader.take_all():
                read = transforms_in(message)
                new.update(read)
                received_s.update(dict.fromkeys(read, now_s))
            outdated_s = reader.outdated_before(now_s)
            for frame in [frame for frame, at_s in received_s.items() if at_s <= outdated_s]:
                del received_s[frame]
                outdated.add(frame)
        # A frame may be published on both topics.
        outdated.difference_update(*self._received_s)
        if new or outdated:
            kept = {**self.transforms, **new}
            self.transforms = MappingProxyType(
                {frame: step for frame, step in kept.items() if frame not in outdated}
            )


def transforms_in(message: TFMessage) -> dict[str, Transform]:
    """Return the valid transforms of a message, by child frame."""
    result: dict[str, Transform] = {}
    for stamped in message.transforms:
        parent, child = frame_name(stamped.header.frame_id), frame_name(stamped.child_frame_id)
        move, turn = stamped.transform.translation, stamped.transform.rotation
        position, rotation = (move.x, move.y, move.z), (turn.x, turn.y, turn.z, turn.w)
        # As in tf2: refuse empty names, a frame as its own parent, NaN, and invalid quaternions.
        if (
            len({"", parent, child}) == 3
            and all(map(math.isfinite, (*position, *rotation)))
            and abs(math.hypot(*rotation) - 1.0) < 0.01
        ):
            result[child] = Transform(parent, RigidTransform(position, rotation))
    return result
