"""The ROS half of the PID controller: its references, states and feed-forward switch."""

import logging
from typing import Any

import numpy as np
from control_msgs.msg import MultiDOFCommand, MultiDOFStateStamped, SingleDOFState
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from rclpy.qos import QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from rclpy.service import Service
from rclpy.subscription import Subscription
from std_srvs.srv import SetBool

from arm_control.pid_controller import STATE_FIELDS, PidController
from arm_control.pid_controller_parameters import PidControllerParameters
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.throttle import Throttle
from arm_node.message_template import MessageTemplate

REFERENCE_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
WARNING_INTERVAL_S = 1.0


class PidControllerAdapter(ControllerAdapter[PidController]):
    """Gives the controller its end points."""

    _end_points: tuple[Publisher | Service | Subscription, ...] = ()

    def on_configure(self, parameters: PidControllerParameters) -> None:
        """Create the end points."""
        self._throttle = Throttle(WARNING_INTERVAL_S)
        publisher = self.node.create_publisher(
            MultiDOFStateStamped, "~/controller_state", QoSPresetProfiles.SYSTEM_DEFAULT.value
        )
        self.controller.sink = PidStatePublisher(publisher, parameters.state_dof_names)
        self._end_points = (
            publisher,
            self.node.create_service(SetBool, "~/set_feedforward_control", self._set_feedforward),
            self.node.create_subscription(
                MultiDOFCommand, "~/reference", self._take_reference, REFERENCE_QOS
            ),
        )
        if parameters.use_external_measured_states:
            self._end_points += (
                self.node.create_subscription(
                    MultiDOFCommand, "~/measured_state", self._take_measured, REFERENCE_QOS
                ),
            )

    def on_cleanup(self) -> None:
        """Destroy the end points."""
        self.controller.sink = None
        self.destroy(*self._end_points)
        self._end_points = ()

    def _take_reference(self, message: MultiDOFCommand) -> None:
        self._complain("reference", self.controller.offer(*_parts(message)))

    def _take_measured(self, message: MultiDOFCommand) -> None:
        self._complain("measured state", self.controller.offer_measured(*_parts(message)))

    def _complain(self, what: str, reason: str) -> None:
        if reason and self._throttle.permits():
            logging.getLogger(self.controller.name).error("a %s was dropped: %s", what, reason)

    def _set_feedforward(self, request: SetBool.Request, response: Any) -> Any:
        self.controller.is_feedforward_enabled = request.data
        response.success = True
        return response


def _parts(message: MultiDOFCommand) -> tuple[list[str], list[float], list[float]]:
    return list(message.dof_names), list(message.values), list(message.values_dot)


class PidStatePublisher:
    """Publishes the state as control_msgs/msg/MultiDOFStateStamped; see `PidStateSink`."""

    def __init__(self, publisher: Publisher, names: tuple[str, ...]) -> None:
        self._publisher = publisher
        self._template = MessageTemplate(
            MultiDOFStateStamped(dof_states=[SingleDOFState(name=name) for name in names])
        )
        self._where = np.stack(
            [self._template.indices(f"dof_states[*].{field}") for field in STATE_FIELDS], axis=1
        )

    def publish(self, time_s: float, state: NDArray[np.float64]) -> None:
        """Publish one state."""
        self._template.set_stamps(round(time_s * 1e9))
        self._template.float64[self._where] = state
        self._template.publish(self._publisher)
