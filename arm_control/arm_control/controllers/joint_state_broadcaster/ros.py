"""The ROS half of the joint state broadcaster: joint_states and dynamic_joint_states."""

import numpy as np
from control_msgs.msg import DynamicJointState, InterfaceValue
from numpy.typing import NDArray
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState

from arm_control.controllers.joint_state_broadcaster.controller import (
    QUANTITIES,
    JointStateBroadcaster,
    JointStateBroadcasterParameters,
    JointStateLayout,
)
from arm_control.controllers.ros_adapter import ControllerAdapter, ReadingPublisher
from arm_control.loop.outbox import Outbox


class JointStateBroadcasterAdapter(ControllerAdapter[JointStateBroadcaster]):
    """Gives the broadcaster its publishers."""

    def on_configure(self, parameters: JointStateBroadcasterParameters) -> None:
        """Create the publishers; on Fast DDS they keep the last message for late subscribers."""
        prefix = "~/" if parameters.use_local_topics else ""
        joint_states = self.publisher(JointState, f"{prefix}joint_states")
        dynamic = None
        if parameters.publish_dynamic_joint_states:
            dynamic = self.publisher(DynamicJointState, f"{prefix}dynamic_joint_states")
        self.controller.sink = _JointStateBroadcastPublisher(
            joint_states, dynamic, parameters.frame_id, self.loop.outbox
        )


class _JointStateBroadcastPublisher:
    """Publishes joint states as sensor_msgs and control_msgs; see `JointStateSink`."""

    def __init__(
        self,
        joint_states: Publisher,
        dynamic_joint_states: Publisher | None,
        frame_id: str,
        outbox: Outbox,
    ) -> None:
        self._outbox = outbox
        self._joint_states = joint_states
        self._dynamic_joint_states = dynamic_joint_states
        self._frame_id = frame_id
        self._joints: ReadingPublisher | None = None
        self._components: ReadingPublisher | None = None

    def open(self, layout: JointStateLayout) -> None:
        """Serialise a message of this layout once; later only its numbers are written."""
        self._joints = self._open_joints(layout)
        self._components = None
        if self._dynamic_joint_states is not None:
            self._components = self._open_components(layout, self._dynamic_joint_states)

    def publish(
        self, time_s: float, joints: NDArray[np.float64], components: NDArray[np.float64]
    ) -> None:
        """Publish one state."""
        if self._joints is not None:
            self._joints.publish(time_s, joints)
        if self._components is not None:
            self._components.publish(time_s, components)

    def _open_joints(self, layout: JointStateLayout) -> ReadingPublisher:
        values = [0.0] * len(layout.joints)
        message = JointState(
            name=list(layout.joints), position=values, velocity=values, effort=values
        )
        message.header.frame_id = self._frame_id
        return ReadingPublisher(self._joint_states, message, QUANTITIES, outbox=self._outbox)

    def _open_components(self, layout: JointStateLayout, publisher: Publisher) -> ReadingPublisher:
        message = DynamicJointState(
            joint_names=[name for name, _ in layout.components],
            interface_values=[
                InterfaceValue(interface_names=list(names), values=[0.0] * len(names))
                for _, names in layout.components
            ],
        )
        message.header.frame_id = self._frame_id
        paths = ("interface_values[*].values",)
        return ReadingPublisher(publisher, message, paths, outbox=self._outbox)
