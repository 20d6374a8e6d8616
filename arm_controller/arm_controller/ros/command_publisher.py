"""Publishes poses for the position controller, each once and so that it arrives."""

from collections.abc import Sequence

from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

from arm_controller.joint_limits import JointLimits
from arm_controller.listener_watch import Audience, ListenerWatch
from arm_controller.pose import JointPose
from arm_controller.ros.clock_time import seconds, steady_clock
from arm_controller.ros.robot_limits import RobotLimits

COMMAND_TOPIC = "position_controller/commands"
DEPTH = 10

POLL_S = 0.05
"""How often whoever waits should `observe`."""

GRACE_S = 2.0
"""So long after the match what is latched or periodic has arrived, or does not exist."""


class CommandPublisher:
    """The publisher, who listens to it, and what the robot can do.

    One thread observes and publishes; the executor's brings the description.

    Args:
        node: the node that publishes.
        joint_names: the joints of a pose.
    """

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        self._node = node
        self._steady = steady_clock()
        self._publisher = node.create_publisher(Float64MultiArray, COMMAND_TOPIC, DEPTH)
        # A controller subscribes to ~/commands, so its node is called as the topic's parent.
        self._watch = ListenerWatch(self.topic.rpartition("/")[0], self._now_s())
        self._robot = RobotLimits(node, joint_names)

    @property
    def topic(self) -> str:
        """The topic's full name, remapping included."""
        return self._publisher.topic_name

    @property
    def limits(self) -> JointLimits:
        """What the robot can do, as far as known."""
        return self._robot.limits

    @property
    def is_ready(self) -> bool:
        """Whether a pose that is published now arrives, and could be checked."""
        if not self._watch.is_ready(self._now_s()):
            return False
        return self._robot.known or self.lasting_s >= GRACE_S

    @property
    def lasting_s(self) -> float:
        """For how long those who listen (or nobody) have done so."""
        return self._watch.lasting_s(self._now_s())

    @property
    def silence_s(self) -> float:
        """For how long nobody has listened; 0 if somebody does."""
        return self.lasting_s if self._watch.audience is Audience.NOBODY else 0.0

    @property
    def audience(self) -> str:
        """A few words on who listens to the topic."""
        return f"{self._watch.describe()} on {self.topic}"

    @property
    def reaches_controller(self) -> bool:
        """Whether the position controller itself listens."""
        return self._watch.audience is Audience.CONTROLLER

    def observe(self) -> None:
        """Look who listens now."""
        listeners: list[str] = []
        # The graph may know of an endpoint before (or without) a match with this publisher.
        if self._publisher.get_subscription_count() > 0:
            listeners = [
                f"{info.node_namespace.rstrip('/')}/{info.node_name}"
                for info in self._node.get_subscriptions_info_by_topic(self.topic)
            ]
        self._watch.observe(listeners, self._now_s())

    def publish(self, pose: JointPose) -> None:
        """Publish the positions of a pose."""
        self._publisher.publish(Float64MultiArray(data=list(pose.positions)))

    def _now_s(self) -> float:
        return seconds(self._steady)
