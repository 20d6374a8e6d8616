"""The topic ~/controller_state of the joint trajectory controller."""

import numpy as np
from control_msgs.msg import JointTrajectoryControllerState
from rclpy.publisher import Publisher

from arm_control.joint_trajectory import ControllerState, StateLayout
from arm_control.ros.joint_trajectory_messages import (
    FIELD_OF_QUANTITY,
    duration_parts,
    point_message,
)
from arm_node.message_template import MessageTemplate

PARTS = ("reference", "feedback", "error", "output")
"""Points of the message and of a `StateLayout`, in the order of `ControllerState.values`."""

TIMED_PARTS = ("reference", "feedback", "error")
"""Points of the message whose time_from_start tells how far the trajectory has got."""


class JointTrajectoryStatePublisher:
    """Publishes states of one layout from a message that is serialised once. Loop thread only."""

    def __init__(self, publisher: Publisher, layout: StateLayout) -> None:
        self._publisher = publisher
        joints = len(layout.joints)
        rows = {part: getattr(layout, part) for part in PARTS}
        message = JointTrajectoryControllerState(
            joint_names=list(layout.joints),
            **{part: point_message(quantities, joints=joints) for part, quantities in rows.items()},
        )
        self._template = MessageTemplate(message)
        self._values = np.concatenate(
            [
                self._template.indices(f"{part}.{FIELD_OF_QUANTITY[quantity]}")
                for part, quantities in rows.items()
                for quantity in quantities
            ]
        )
        self._times = np.concatenate(
            [self._template.time_indices(f"{part}.time_from_start") for part in TIMED_PARTS]
        )
        self._speed_scaling = self._template.doubles("speed_scaling_factor")

    def publish(self, state: ControllerState) -> None:
        """Publish one state."""
        self._template.set_stamps(round(state.time_s * 1e9))
        self._template.float64[self._values] = state.values.ravel()
        progress = state.progress
        self._template.int32[self._times] = (
            *duration_parts(progress.reference_s),
            *duration_parts(progress.feedback_s),
            *duration_parts(progress.error_s),
        )
        self._speed_scaling[:] = state.speed_scaling
        self._template.publish(self._publisher)
