"""Publishes poses for the position controller, or for one controller of each joint."""

from collections.abc import Sequence

from rclpy.node import Node
from std_msgs.msg import Float64, Float64MultiArray

from arm_controller.joint_limits import JointLimits
from arm_controller.listener_watch import Audience
from arm_controller.pose import JointPose
from arm_controller.ros.command_topic import CommandTopic
from arm_controller.ros.parameters import JOINT_MARK, declare_command_topic
from arm_controller.ros.robot_limits import RobotLimits

POLL_S = 0.05
"""How often whoever waits should `observe`."""

GRACE_S = 2.0
"""So long after the match what is latched or periodic has arrived, or does not exist."""


class CommandPublisher:
    """The topics of the commands, who listens to them, and what the robot can do.

    It declares the node's parameter `command_topic`. One thread observes and publishes; the
    executor's brings the description.

    Args:
        node: the node that publishes.
        joint_names: the joints of a pose.

    Raises:
        ParameterValueError: the parameter makes no sense.
    """

    def __init__(self, node: Node, joint_names: Sequence[str]) -> None:
        name = declare_command_topic(node)
        self._is_split = JOINT_MARK in name
        if self._is_split:
            names = [name.replace(JOINT_MARK, joint) for joint in joint_names]
            self._topics = [CommandTopic(node, Float64, own) for own in names]
        else:
            self._topics = [CommandTopic(node, Float64MultiArray, name)]
        self._robot = RobotLimits(node, joint_names)

    @property
    def limits(self) -> JointLimits:
        """What the robot can do, as far as known."""
        return self._robot.limits

    @property
    def is_ready(self) -> bool:
        """Whether a pose that is published now arrives, and could be checked."""
        if not all(topic.is_ready for topic in self._topics):
            return False
        return self._robot.known or self.lasting_s >= GRACE_S

    @property
    def lasting_s(self) -> float:
        """For how long those who listen (or nobody) have done so; where least attended."""
        return self._least_attended.lasting_s

    @property
    def silence_s(self) -> float:
        """For how long nobody has listened; 0 if somebody does."""
        return self.lasting_s if self._least_attended.audience is Audience.NOBODY else 0.0

    @property
    def audience(self) -> str:
        """A few words on who listens; where least attended."""
        return self._least_attended.describe_audience()

    @property
    def reaches_controller(self) -> bool:
        """Whether every position controller itself listens."""
        return self._least_attended.audience is Audience.CONTROLLER

    def observe(self) -> None:
        """Look who listens now."""
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
    def _least_attended(self) -> CommandTopic:
        ranks = list(Audience)
        return min(self._topics, key=lambda topic: (ranks.index(topic.audience), topic.lasting_s))
