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
from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.loop.outbox import Outbox
from arm_node.workarounds.message_template import MessageTemplate, raw_sender


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


class _StampedArray:
    """A message of fixed shape whose float64 values are one flat array. Loop thread only."""

    def __init__(
        self,
        publisher: Publisher,
        template: MessageTemplate,
        where: NDArray[np.intp],
        outbox: Outbox,
    ) -> None:
        self._send = raw_sender(publisher)
        self._outbox = outbox
        self._template = template
        self._where = where

    def publish(self, stamp_ns: int, values: NDArray[np.float64]) -> None:
        self._template.set_stamps(stamp_ns)
        self._template.float64[self._where] = values
        self._outbox.put(self._send, self._template.to_bytes())


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
        self._joints: _StampedArray | None = None
        self._components: _StampedArray | None = None

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
        stamp_ns = round(time_s * 1e9)
        if self._joints is not None:
            self._joints.publish(stamp_ns, joints)
        if self._components is not None:
            self._components.publish(stamp_ns, components)

    def _open_joints(self, layout: JointStateLayout) -> _StampedArray:
        values = [0.0] * len(layout.joints)
        message = JointState(
            name=list(layout.joints), position=values, velocity=values, effort=values
        )
        message.header.frame_id = self._frame_id
        template = MessageTemplate(message)
        where = np.concatenate([template.indices(quantity) for quantity in QUANTITIES])
        return _StampedArray(self._joint_states, template, where, self._outbox)

    def _open_components(self, layout: JointStateLayout, publisher: Publisher) -> _StampedArray:
        message = DynamicJointState(
            joint_names=[name for name, _ in layout.components],
            interface_values=[
                InterfaceValue(interface_names=list(names), values=[0.0] * len(names))
                for _, names in layout.components
            ],
        )
        message.header.frame_id = self._frame_id
        template = MessageTemplate(message)
        where = template.indices("interface_values[*].values")
        return _StampedArray(publisher, template, where, self._outbox)
