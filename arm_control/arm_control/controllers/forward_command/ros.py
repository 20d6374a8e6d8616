"""The ROS half of the controllers that forward commands: the command topic."""

import logging
from collections.abc import Sequence
from typing import Any, ClassVar

from std_msgs.msg import Float64, Float64MultiArray

from arm_control.controllers.forward_command.controller import DROPPED, SHOWN, ForwardCommander
from arm_control.controllers.ros_adapter import ControllerAdapter


class ForwardCommandAdapter(ControllerAdapter[ForwardCommander[Any]]):
    """Passes each std_msgs/msg/Float64MultiArray on ~/commands to the core.

    Attributes:
        message_type: class of the message.
        topic: topic of the commands.
    """

    message_type: ClassVar[type[Any]] = Float64MultiArray
    topic: ClassVar[str] = "~/commands"

    def on_configure(self, parameters: Any) -> None:
        """Subscribe; best effort on Fast DDS, so that every publisher matches."""
        self.subscribe(self.message_type, self.topic, self._take)

    def values_of(self, message: Any) -> Sequence[float]:
        """Return the numbers in a message."""
        return message.data

    def _take(self, message: Any) -> None:
        if not self.takes_commands(self.topic):
            return
        values = self.values_of(message)
        if not self.controller.offer(values) and self._throttle.permits():
            logging.getLogger(self.controller.name).warning(DROPPED, list(values)[:SHOWN])


class JointCommandAdapter(ForwardCommandAdapter):
    """Passes each std_msgs/msg/Float64 on ~/command to the core, like ROS 1 controllers."""

    message_type = Float64
    topic = "~/command"

    def values_of(self, message: Float64) -> Sequence[float]:
        """Return the number in a message."""
        return (message.data,)
