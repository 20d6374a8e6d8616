"""Publishes poses for the position controller, or for one controller per joint.

A position controller subscribes with best effort. A message that is published right after the match
may be lost; 0.2 s later it arrives. While the controller is still starting, the message must not go
only to an echo or a recorder.
"""

import time
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float64, Float64MultiArray, String

from arm_controller.pose import AllowedRange, ArmControllerError, Limits, Pose, read_limits
from arm_controller.ros_parameters import declare
from arm_description.errors import DescriptionError
from arm_node.parameter_values import read_nonempty_text

POLL_S = 0.05
"""Interval at which a waiting node should call `observe`."""
SETTLE_S = 0.2
"""How long after a match messages may still be lost."""
OTHERS_WAIT_S = 5.0
"""How long to wait for the controller before accepting another subscriber."""
GRACE_S = 2.0
"""How long after a match to wait for latched and periodic topics before going on without."""
NOBODY, OTHERS, CONTROLLER = range(3)
JOINT_MARK = "{joint}"
"""Placeholder for a joint's name in the name of a topic."""


class MatchedPublisher:
    """A publisher that knows its subscribers; one thread.

    Attributes:
        topic: the topic's full name, remapping included.
        subscribers: NOBODY, OTHERS or the CONTROLLER, at the last `observe`.
    """

    def __init__(self, node: Node, message_type: type[Any], name: str) -> None:
        self._node = node
        self._publisher = node.create_publisher(message_type, name, 10)
        self.topic: str = self._publisher.topic_name
        # A controller's topics are below its node's name, so the topic's parent is that name.
        self._controller = self.topic.rpartition("/")[0]
        self._names: set[str] = set()
        self.subscribers = NOBODY
        self._since_s = time.monotonic()

    def observe(self) -> None:
        """Look up who subscribes now."""
        # The graph may contain an end point before (or without) a match with this publisher.
        matched = self._publisher.get_subscription_count() > 0
        found = self._node.get_subscriptions_info_by_topic(self.topic) if matched else []
        self._names = {f"{end.node_namespace.rstrip('/')}/{end.node_name}" for end in found}
        kind = CONTROLLER if self._controller in self._names else min(len(self._names), OTHERS)
        if kind != self.subscribers:
            self.subscribers, self._since_s = kind, time.monotonic()

    @property
    def unchanged_s(self) -> float:
        """How long `subscribers` has been unchanged."""
        return time.monotonic() - self._since_s

    @property
    def is_ready(self) -> bool:
        """Whether a command that is published now will arrive."""
        wait_s = SETTLE_S if self.subscribers == CONTROLLER else OTHERS_WAIT_S
        return self.subscribers != NOBODY and self.unchanged_s >= wait_s

    @property
    def silence_s(self) -> float:
        """How long there has been no subscriber; 0 if there is one."""
        return self.unchanged_s if self.subscribers == NOBODY else 0.0

    def describe_subscribers(self) -> str:
        """Return a phrase that says who subscribes to which topic."""
        if self.subscribers == CONTROLLER:
            return f"{self._controller} listens on {self.topic}"
        if self.subscribers == NOBODY:
            return f"nobody listens on {self.topic}"
        verb = "listens" if len(self._names) == 1 else "listen"
        names = ", ".join(sorted(self._names))
        return f"only {names} {verb}, not {self._controller} on {self.topic}"

    def publish(self, message: object) -> None:
        """Publish one command."""
        self._publisher.publish(message)


class PositionCommands:
    """Publishes poses; knows the subscribers and the robot's limits.

    It declares the node's parameter `command_topic`. With several topics, the properties describe
    the one that is least ready.

    Attributes:
        limits: of the joints, from the latched description; until it arrives, none.

    Raises:
        ParameterValueError: the parameter is invalid.
    """

    def __init__(self, node: Node, joints: Sequence[str]) -> None:
        name = declare(
            node,
            "command_topic",
            "position_controller/commands",
            lambda value: read_nonempty_text(value, "the name of a topic"),
            "Topic of the poses: one std_msgs/msg/Float64MultiArray or, if it contains {joint}, "
            "one std_msgs/msg/Float64 per joint",
        )
        if JOINT_MARK in name:
            names = [name.replace(JOINT_MARK, joint) for joint in joints]
            self._topics = [MatchedPublisher(node, Float64, own) for own in names]
        else:
            self._topics = [MatchedPublisher(node, Float64MultiArray, name)]
        self._is_split = JOINT_MARK in name
        self._joints = tuple(joints)
        self._logger = node.get_logger()
        self.limits: Limits = tuple(AllowedRange(joint) for joint in joints)
        self._is_described = False
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, "robot_description", self._take_description, qos)

    @property
    def is_ready(self) -> bool:
        """Whether a pose that is published now will arrive, and its limits could be checked."""
        if not all(topic.is_ready for topic in self._topics):
            return False
        return self._is_described or self.unchanged_s >= GRACE_S

    @property
    def unchanged_s(self) -> float:
        """How long the kind of subscribers has been unchanged."""
        return self._least_ready.unchanged_s

    @property
    def silence_s(self) -> float:
        """How long there has been no subscriber; 0 if there is one."""
        return self._least_ready.silence_s

    @property
    def listeners(self) -> str:
        """A phrase that says who subscribes."""
        return self._least_ready.describe_subscribers()

    @property
    def reaches_controller(self) -> bool:
        """Whether every position controller subscribes."""
        return self._least_ready.subscribers == CONTROLLER

    @property
    def _least_ready(self) -> MatchedPublisher:
        return min(self._topics, key=lambda topic: (topic.subscribers, topic.unchanged_s))

    def observe(self) -> None:
        """Look up who subscribes now."""
        for topic in self._topics:
            topic.observe()

    def publish(self, pose: Pose) -> None:
        """Publish the positions of a pose."""
        if not self._is_split:
            self._topics[0].publish(Float64MultiArray(data=list(pose)))
            return
        for topic, position in zip(self._topics, pose, strict=True):
            topic.publish(Float64(data=position))

    def _take_description(self, message: String) -> None:
        try:
            self.limits = read_limits(message.data, self._joints)
            self._is_described = True
        except (DescriptionError, ArmControllerError) as error:
            self._logger.error(f"/robot_description has no usable joint limits: {error}")
