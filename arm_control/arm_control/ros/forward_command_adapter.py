"""The ROS half of the controllers that forward commands: the topic ~/commands."""

import logging
from typing import Any

from rclpy.qos import QoSPresetProfiles
from rclpy.subscription import Subscription
from std_msgs.msg import Float64MultiArray

from arm_control.forward_command_controller import ForwardCommander
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.throttle import Throttle

WARNING_INTERVAL_S = 1.0


class ForwardCommandAdapter(ControllerAdapter[ForwardCommander[Any]]):
    """Hands each std_msgs/msg/Float64MultiArray of ~/commands to the core."""

    _subscription: Subscription | None = None

    def on_configure(self, parameters: Any) -> None:
        """Subscribe; best effort on Fast DDS, so that every publisher matches."""
        self._throttle = Throttle(WARNING_INTERVAL_S)
        self._subscription = self.node.create_subscription(
            Float64MultiArray,
            "~/commands",
            self._take,
            QoSPresetProfiles.SYSTEM_DEFAULT.value,
        )

    def on_cleanup(self) -> None:
        """Unsubscribe."""
        if self._subscription is not None:
            self.node.destroy_subscription(self._subscription)
            self._subscription = None

    def _take(self, message: Float64MultiArray) -> None:
        if not self.controller.offer(message.data) and self._throttle.permits():
            logging.getLogger(self.controller.name).warning(
                "a command with a NaN or an infinity was dropped: %s", list(message.data)[:16]
            )
