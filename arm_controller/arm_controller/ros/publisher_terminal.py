"""The node publisher_terminal: the ROS half of the dialogue."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from rclpy.node import Node

from arm_controller.errors import DeliveryError
from arm_controller.joint_pose import JointPose
from arm_controller.ros.command_publisher import POLL_S, CommandPublisher
from arm_controller.ros.parameters import declare_joints, declare_match_timeout_s

if TYPE_CHECKING:
    from arm_node.process import NodeProcess

PACE_S = 0.1
"""The controller keeps only the latest command, so lines from a pipe need a pause between them."""


class PublisherTerminal(Node):
    """Delivers poses one after the other; the calling thread waits.

    Args:
        process: the process, whose shutdown ends every wait.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self, process: "NodeProcess") -> None:
        super().__init__("publisher_terminal")
        self._process = process
        self.joint_names = declare_joints(self)
        self._match_timeout_s = declare_match_timeout_s(self)
        self._commands = CommandPublisher(self, self.joint_names)

    def deliver(self, pose: JointPose, announce: Callable[[], None]) -> None:
        """Publish a pose as soon as it can arrive, and wait until it has.

        Call it outside the executor's thread, which must keep running meanwhile.

        Args:
            pose: the pose to publish.
            announce: called right before the pose is published.

        Raises:
            PoseError: the pose exceeds the robot's limits.
            DeliveryError: there was no subscriber for match_timeout.
        """
        while not self._process.stopping:
            self._commands.observe()
            self._commands.limits.check(pose)
            if self._commands.is_ready:
                announce()
                self._commands.publish(pose)
                self._process.wait(PACE_S)
                return
            if self._commands.silence_s >= self._match_timeout_s:
                raise DeliveryError(
                    f"Not published: {self._commands.listeners}. Is the position_controller active?"
                )
            self._process.wait(POLL_S)
        raise DeliveryError("Not published: the program is shutting down.")
