"""The robot as a node sees it: commands out, joint states and limits in.

A position controller subscribes with best effort. A message that is published right after the match
may be lost; 0.2 s later it arrives. While the controller is still starting, the message must not go
only to an echo or a recorder.
"""

import time
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray, String

from arm_controller.pose import Limits, Pose, PoseError, check_limits, read_limits
from arm_controller.ros_node import declare, spin_for

POLL_S = 0.05
"""Interval at which a waiting node should call `observe`."""
SETTLE_S = 0.2
"""How long after a match messages may still be lost."""
OTHERS_WAIT_S = 5.0
"""How long to wait for the controller before accepting another subscriber."""
GRACE_S = 2.0
"""How long after a match to wait for latched and periodic topics before going on without."""
SILENCE_S = 5.0
"""How long /joint_states may be silent before that is reported."""
NOBODY, OTHERS, CONTROLLER = range(3)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class MatchedPublisher:
    """A publisher that knows its subscribers.

    Attributes:
        topic: the topic's full name, remapping included.
        subscribers: NOBODY, OTHERS or the CONTROLLER, at the last `observe`.
    """

    def __init__(self, node: Node, message_type: type[Any], name: str) -> None:
        self._node = node
        self._publisher = node.create_publisher(message_type, name, 10)
        self.publish = self._publisher.publish
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
        names = ", ".join(sorted(self._names))
        return f"{self._controller} does not listen on {self.topic}, only {names}"

    def wait_until_ready(self, timeout_s: float) -> bool:
        """Serve the node until a command would arrive; log an error if there is no subscriber."""
        logger = self._node.get_logger()
        while not self.is_ready:
            spin_for(self._node, POLL_S)
            self.observe()
            if self.silence_s >= timeout_s:
                logger.error(f"{self.describe_subscribers()}: is the controller active?")
                return False
        logger.info(f"publishing on {self.topic}")
        return True


class PositionCommands:
    """Publishes poses for the position controller, or for one controller per joint.

    It declares the node's parameter `command_topic`, and takes the limits of the joints from the
    latched description.
    """

    def __init__(self, node: Node, joints: Sequence[str]) -> None:
        about = (
            "Topic of the poses: one std_msgs/msg/Float64MultiArray or, if it contains {joint}, "
            "one std_msgs/msg/Float64 per joint"
        )
        name = declare(node, "command_topic", "position_controller/commands", about)
        self._is_split = "{joint}" in name
        kind = Float64 if self._is_split else Float64MultiArray
        names = dict.fromkeys(name.replace("{joint}", joint) for joint in joints)
        self._topics = [MatchedPublisher(node, kind, name) for name in names]
        self._joints = joints
        self._logger = node.get_logger()
        self._limits: Limits | None = None
        node.create_subscription(String, "robot_description", self._take_description, LATCHED)

    def check(self, pose: Pose) -> None:
        """Check that the robot can reach a pose; before the description arrives it can reach all.

        Raises:
            PoseError: a position is beyond its joint's limits.
        """
        check_limits(pose, self._joints, self._limits or {})

    def observe(self) -> MatchedPublisher:
        """Look up who subscribes now; return the topic that is least ready."""
        for topic in self._topics:
            topic.observe()
        return min(self._topics, key=lambda topic: (topic.subscribers, topic.unchanged_s))

    @property
    def is_ready(self) -> bool:
        """Whether a pose that is published now will arrive, and its limits could be checked."""
        is_late = all(topic.unchanged_s >= GRACE_S for topic in self._topics)
        return all(t.is_ready for t in self._topics) and (self._limits is not None or is_late)

    def publish(self, pose: Pose) -> None:
        """Publish the positions of a pose."""
        if not self._is_split:
            self._topics[0].publish(Float64MultiArray(data=list(pose)))
            return
        for topic, position in zip(self._topics, pose, strict=True):
            topic.publish(Float64(data=position))

    def _take_description(self, message: String) -> None:
        try:
            self._limits = read_limits(message.data, self._joints)
        except PoseError as error:
            self._logger.error(f"/robot_description has no usable joint limits: {error}")


class JointReadings:
    """The latest state of each joint, from /joint_states; messages may name different joints.

    Attributes:
        states: position (rad or m), velocity and effort by joint name; nan where there is none.
    """

    def __init__(self, node: Node) -> None:
        self.states: dict[str, tuple[float, float, float]] = {}
        self._logger = node.get_logger()
        self._heard_s = time.monotonic()
        self._has_news = self._is_silent = False
        qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        node.create_subscription(JointState, "joint_states", self.take, qos)

    def take(self, message: JointState) -> None:
        """Keep what a message says."""
        self._heard_s, self._is_silent = time.monotonic(), False
        missing = [float("nan")] * len(message.name)
        columns = [
            values if len(values) == len(missing) else missing
            for values in (message.position, message.velocity, message.effort)
        ]
        self.states.update(zip(message.name, zip(*columns, strict=True), strict=True))
        self._has_news = True

    def has_news(self) -> bool:
        """Return whether a message came since the last call; warn once if the topic is silent."""
        has_news, self._has_news = self._has_news, False
        if not self._is_silent and time.monotonic() - self._heard_s >= SILENCE_S:
            self._is_silent = True
            self._logger.warning(
                f"/joint_states has been silent for {SILENCE_S:g} s: is the "
                "joint_state_broadcaster inactive, or the simulation paused?"
            )
        return has_news
