"""The ROS half of the PID controller: its references, states and feed-forward switch."""

import logging
from collections.abc import Sequence
from typing import Any

import numpy as np
from control_msgs.msg import MultiDOFCommand, MultiDOFStateStamped, PidState, SingleDOFState
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from rclpy.qos import QoSPresetProfiles
from std_srvs.srv import SetBool

from arm_control.controllers.pid_controller.controller import (
    STATE_FIELDS,
    PidController,
    PidControllerParameters,
    PidTerms,
)
from arm_control.controllers.ros_adapter import ControllerAdapter, duration_message, time_message
from arm_node.names import as_node_name
from arm_node.qos import NEWEST
from arm_node.workarounds.message_template import MessageTemplate


class PidControllerAdapter(ControllerAdapter[PidController]):
    """Connects the controller to its topics and its service."""

    def on_configure(self, parameters: PidControllerParameters) -> None:
        """Create the end points."""
        publisher = self.publisher(MultiDOFStateStamped, "~/controller_state")
        # One for each, because `activate_state_publisher` may be set at any time.
        sensor_data = QoSPresetProfiles.SENSOR_DATA.value
        terms = [
            self.publisher(PidState, f"~/{_as_topic(dof)}/pid_state", sensor_data)
            for dof in parameters.dof_names
        ]
        self.controller.sink = _PidStatePublisher(publisher, parameters.state_dof_names, terms)
        self.serve(SetBool, "~/set_feedforward_control", self._set_feedforward)
        self.subscribe(MultiDOFCommand, "~/reference", self._take_reference, NEWEST)
        if parameters.use_external_measured_states:
            self.subscribe(MultiDOFCommand, "~/measured_state", self._take_measured, NEWEST)

    def _take_reference(self, message: MultiDOFCommand) -> None:
        if self.takes_commands("~/reference"):
            self.warn_dropped("reference", self.controller.offer(*_parts(message)), logging.ERROR)

    def _take_measured(self, message: MultiDOFCommand) -> None:
        reason = self.controller.offer_measured(*_parts(message))
        self.warn_dropped("measured state", reason, logging.ERROR)

    def _set_feedforward(self, request: SetBool.Request, response: Any) -> Any:
        self.controller.enable_feedforward(request.data)
        response.success = True
        return response


def _as_topic(dof: str) -> str:
    """Return a degree of freedom's name in a form that topic names allow."""
    return "/".join(as_node_name(part) for part in dof.split("/") if part)


def _parts(message: MultiDOFCommand) -> tuple[list[str], list[float], list[float]]:
    return list(message.dof_names), list(message.values), list(message.values_dot)


class _PidStatePublisher:
    """Publishes the state as control_msgs/msg/MultiDOFStateStamped; see `PidStateSink`.

    The terms of an output are published as control_msgs/msg/PidState.
    """

    def __init__(
        self, publisher: Publisher, names: tuple[str, ...], terms: Sequence[Publisher] = ()
    ) -> None:
        self._publisher = publisher
        self._terms = terms
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

    def publish_terms(self, time_s: float, dof: int, terms: PidTerms) -> None:
        """Publish the terms of an output."""
        gains = terms.gains
        message = PidState(
            timestep=duration_message(terms.period_s),
            error=terms.error,
            error_dot=terms.error_rate,
            p_error=terms.error,
            i_error=terms.integral,
            d_error=terms.error_rate,
            p_term=gains.p,
            i_term=gains.i,
            d_term=gains.d,
            i_max=gains.i_clamp_max,
            i_min=gains.i_clamp_min,
            output=terms.output,
        )
        message.header.stamp = time_message(time_s)
        self._terms[dof].publish(message)
