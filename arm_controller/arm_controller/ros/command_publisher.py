"""Publishes poses for the position controller, or for one controller per joint."""

import logging
import time
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float64, Float64MultiArray, String

from arm_controller.errors import ArmControllerError
from arm_controller.joint_pose import JointPose, PoseLimits, limits_of, no_limits
from arm_controller.ros.parameters import JOINT_MARK, declare_command_topic
from arm_controller.subscriber_watch import Subscribers, SubscriberWatch
from arm_description.errors import DescriptionError
from arm_description.urdf.parser import parse_urdf

DESCRIPTION_TOPIC = "robot_description"
DEPTH = 10
POLL_S = 0.05
"""Interval at which a waiting caller should call `observe`."""

GRACE_S = 2.0
"""How long after a match to wait for latched and periodic topics before going on without."""

logger = logging.getLogger(__name__)


class MatchedPublisher:
    """A publisher that knows its subscribers; one thread.

    Args:
        node: the node that publishes.
        message_type: class of the messages.
        name: name of the topic.
    """

    def __init__(self, node: Node, message_type: type[Any], name: str) -> None:
        self._node = node
        self._publisher = node.create_publisher(message_type, name, DEPTH)
        # A controller's topics are below its node's name, so the topic's parent is that name.
        self._watch = SubscriberWatch(self.name.rpartition("/")[0], time.monotonic())

    @property
    def name(self) -> str:
        """The topic's full name, remapping included."""
        return self._publisher.topic_name

    @property
    def is_ready(self) -> bool:
        """Whether a command that is published now will arrive."""
        return self._watch.is_ready(time.monotonic())

    @property
    def unchanged_s(self) -> float:
        """How long `subscribers` has been unchanged."""
        return self._watch.unchanged_s(time.monotonic())

    @property
    def subscribers(self) -> Subscribers:
        """The subscribers at the last `observe`."""
        return self._watch.subscribers

    def describe_subscribers(self) -> str:
        """Return a phrase that says who subscribes to which topic."""
        return f"{self._watch.describe()} on {self.name}"

    def observe(self) -> None:
        """Look up who subscribes now."""
        names: list[str] = []
        # The graph may contain an end point before (or without) a match with this publisher.
        if self._publisher.get_subscription_count() > 0:
            names = [
                f"{info.node_namespace.rstrip('/')}/{info.node_name}"
                for info in self._node.get_subscriptions_info_by_topic(self.name)
            ]
        self._watch.observe(names, time.monotonic())

    def publish(self, message: object) -> None:
        """Publish one command."""
        self._publisher.publish(message)


class CommandPublisher:
    """Publishes poses; knows the subscribers and the robot's limits.

    It declares the node's parameter `command_topic`. One thread calls `observe` and `publish`; the
    description arrives in the executor's thread. With several topics, the properties describe the
    one that is least ready.

    Args:
        node: the node that publishes.
        joint_names: the joints of a pose.

    Raises:
        ParameterValueError: the parameter is invalid.
    """

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        name = declare_command_topic(node)
        self._is_split = JOINT_MARK in name
        if self._is_split:
            names = [name.replace(JOINT_MARK, joint) for joint in joint_names]
            self._topics = [MatchedPublisher(node, Float64, own) for own in names]
        else:
            self._topics = [MatchedPublisher(node, Float64MultiArray, name)]
        self._robot = _DescribedLimits(node, joint_names)

    @property
    def limits(self) -> PoseLimits:
        """The known limits of the robot."""
        return self._robot.limits

    @property
    def is_ready(self) -> bool:
        """Whether a pose that is published now will arrive, and its limits could be checked."""
        if not all(topic.is_ready for topic in self._topics):
            return False
        return self._robot.known or self.unchanged_s >= GRACE_S

    @property
    def unchanged_s(self) -> float:
        """How long the kind of subscribers has been unchanged."""
        return self._last_matched.unchanged_s

    @property
    def silence_s(self) -> float:
        """How long there has been no subscriber; 0 if there is one."""
        return self.unchanged_s if self._last_matched.subscribers is Subscribers.NONE else 0.0

    @property
    def listeners(self) -> str:
        """A phrase that says who subscribes."""
        return self._last_matched.describe_subscribers()

    @property
    def reaches_controller(self) -> bool:
        """Whether every position controller subscribes."""
        return self._last_matched.subscribers is Subscribers.CONTROLLER

    def observe(self) -> None:
        """Look up who subscribes now."""
        for topic in self._topics:
            topic.observe()

    def publish(self, pose: JointPose) -> None:
        """Publish the positions of a pose."""
        positions = list(pose.positions)
        if not self._is_split:
            self._topics[0].publish(Float64MultiArray(data=positions))
            return
        for topic, position in zip(self._topics, positions, strict=True):
            topic.publish(Float64(data=position))

    @property
    def _last_matched(self) -> MatchedPublisher:
        ranks = list(Subscribers)
        return min(
            self._topics, key=lambda topic: (ranks.index(topic.subscribers), topic.unchanged_s)
        )


class _DescribedLimits:
    """The limits in the latched robot description; until it arrives, every pose is allowed."""

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        self._joint_names = tuple(joint_names)
        self.limits = no_limits(joint_names)
        self.known = False
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscription = node.create_subscription(String, DESCRIPTION_TOPIC, self._take, qos)

    def _take(self, message: String) -> None:
        try:
            self.limits = limits_of(parse_urdf(message.data, DESCRIPTION_TOPIC), self._joint_names)
        except (DescriptionError, ArmControllerError) as error:
            logger.error("/%s has no usable joint limits: %s", DESCRIPTION_TOPIC, error)
            return
        self.known = True
