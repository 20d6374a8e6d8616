"""The node robot_state_publisher: joint states and a URDF in, /tf and /tf_static out."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSPolicyKind, QoSProfile, qos_profile_sensor_data
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from arm_description.errors import DescriptionError
from arm_description.joint_state_encoding import (
    NANOSECONDS,
    EncodingError,
    JointPositions,
    read_joint_positions,
)
from arm_description.names import listing
from arm_description.ros.stamp_clock import StampClock
from arm_description.ros.transform_publisher import TransformPublisher
from arm_description.state_publisher_settings import StatePublisherSettings
from arm_description.state_throttle import StateThrottle
from arm_description.transform_tree import Motion, TransformTree
from arm_description.urdf import parse_urdf

COMPLAINT_INTERVAL_S = 5.0
MOST_OUTLETS = 32
"""Kinds of joint states (by the joints they name) whose messages are kept laid out."""

_TF_QOS = QoSProfile(depth=100)
_LATCHED_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_PARAMETERS = {
    "robot_description": ("", "the robot's URDF"),
    "publish_frequency": (20.0, "highest frequency of /tf in Hz, 0 to 1000; 0 sends all"),
    "frame_prefix": ("", "put before every frame's name as it stands"),
    "ignore_timestamp": (False, "publish every joint state, whatever its stamp"),
}


@dataclass(frozen=True, slots=True)
class _Outlet:
    """What is sent for joint states that name the same joints."""

    names: tuple[str, ...]
    motion: Motion
    publisher: TransformPublisher


class RobotStatePublisher(Node):
    """Publishes where the links are; every callback runs in the executor's thread.

    Raises:
        SettingsError: a parameter that cannot be used, above all an empty robot_description.
        XmlError, UrdfError: the description is not a robot.
    """

    def __init__(self) -> None:
        super().__init__("robot_state_publisher")
        self._stamp_clock = StampClock(self)
        for name, (default, description) in _PARAMETERS.items():
            # Dynamic, so that `publish_frequency: 30` of a YAML file, an integer, is taken too.
            descriptor = ParameterDescriptor(description=description, dynamic_typing=True)
            self.declare_parameter(name, default, descriptor)
        self._settings = self._checked(())
        self._tree = TransformTree(parse_urdf(self._settings.robot_description))
        self._throttle = StateThrottle(self._settings.publish_frequency_hz)
        self._outlets: dict[tuple[str, ...], _Outlet] = {}
        self._description_publisher = self.create_publisher(
            String, "robot_description", _LATCHED_QOS
        )
        policies = (QoSPolicyKind.DEPTH, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY)
        self._static_publisher = self.create_publisher(
            TFMessage,
            "/tf_static",
            _LATCHED_QOS,
            qos_overriding_options=QoSOverridingOptions(policies),
        )
        self._tf_publisher = self.create_publisher(
            TFMessage,
            "/tf",
            _TF_QOS,
            qos_overriding_options=QoSOverridingOptions((*policies, QoSPolicyKind.DURABILITY)),
        )
        self.create_subscription(
            JointState,
            "joint_states",
            self._on_joint_state,
            qos_profile_sensor_data,
            raw=True,
            qos_overriding_options=QoSOverridingOptions(policies),
        )
        # After all declarations: those of the QoS overrides would pass through these too.
        self.add_on_set_parameters_callback(self._refuse_or_accept)
        self.add_post_set_parameters_callback(self._take_parameters)
        self._publish_description()
        self._publish_static()

    def _checked(self, changes: Sequence[Parameter]) -> StatePublisherSettings:
        values = {name: self.get_parameter(name).value for name in _PARAMETERS}
        values.update((change.name, change.value) for change in changes)
        return StatePublisherSettings.from_parameters(values)

    def _refuse_or_accept(self, changes: list[Parameter]) -> SetParametersResult:
        try:
            settings = self._checked(changes)
            if settings.robot_description != self._settings.robot_description:
                parse_urdf(settings.robot_description)
        except DescriptionError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take_parameters(self, _changes: list[Parameter]) -> None:
        before, self._settings = self._settings, self._checked(())
        self._throttle.set_frequency(self._settings.publish_frequency_hz)
        if self._settings.robot_description != before.robot_description:
            self._tree = TransformTree(parse_urdf(self._settings.robot_description))
            self._publish_description()
        elif self._settings.frame_prefix == before.frame_prefix:
            return
        self._outlets.clear()
        self._publish_static()

    def _publish_description(self) -> None:
        self._description_publisher.publish(String(data=self._settings.robot_description))

    def _publish_static(self) -> None:
        # One message of all: it takes the place of the one that late subscribers would get.
        TransformPublisher(
            self._static_publisher, self._tree.static_frames, self._settings.frame_prefix
        ).publish(self._tree.static_transforms, self._now_ns())

    def _now_ns(self) -> int:
        return self.get_clock().now().nanoseconds

    def _on_joint_state(self, data: bytes) -> None:
        try:
            state = read_joint_positions(data)
        except EncodingError as error:
            self._complain(f"a JointState whose bytes cannot be read: {error}")
            return
        if len(state.names) != len(state.positions):
            self._complain_of_sizes(state)
            return
        if state.stamp_ns < 0:
            stamp_s = state.stamp_ns / NANOSECONDS
            about = f"a JointState about {listing(state.names)}"
            self._complain(f"{about}: its stamp, {stamp_s:g} s, is negative")
            return
        self._stamp_clock.hear(state.names, state.stamp_ns)
        if self._throttle.went_back(self.get_clock().now().nanoseconds):
            # Throttled: with a second /clock about, this is so at every other message.
            self.get_logger().warning(
                "Moved backwards in time, re-publishing joint transforms!",
                throttle_duration_sec=COMPLAINT_INTERVAL_S,
            )
        outlet = self._outlet(state.names)
        if not outlet.names:
            return
        if self._settings.ignore_timestamp or self._throttle.due(outlet.names, state.stamp_ns):
            self._publish(outlet, state)

    def _publish(self, outlet: _Outlet, state: JointPositions) -> None:
        transforms = outlet.motion.transforms(state.positions)
        finite = np.isfinite(transforms).all(axis=1)
        if not finite.all():
            child = outlet.motion.frames[int(np.argmin(finite))].child
            self._complain(
                f"a JointState about {listing(outlet.names)}: a position is not a finite number, "
                f"or too large for link {child!r}"
            )
            return
        outlet.publisher.publish(transforms, state.stamp_ns)
        self._throttle.passed_on(outlet.names, state.stamp_ns)

    def _outlet(self, names: tuple[str, ...]) -> _Outlet:
        outlet = self._outlets.get(names)
        if outlet is None:
            if len(self._outlets) >= MOST_OUTLETS:
                self._outlets.clear()
            outlet = self._outlets[names] = self._lay_out(names)
        return outlet

    def _lay_out(self, names: tuple[str, ...]) -> _Outlet:
        motion = self._tree.motion(names)
        return _Outlet(
            names=tuple(names[source] for source in dict.fromkeys(motion.source.tolist())),
            motion=motion,
            publisher=TransformPublisher(
                self._tf_publisher, motion.frames, self._settings.frame_prefix
            ),
        )

    def _complain_of_sizes(self, state: JointPositions) -> None:
        about = f"a JointState about {listing(state.names)}"
        if len(state.positions) == 0:
            # Lawful: a message of velocities only. Whoever wonders why nothing moves sees it.
            self.get_logger().warning(
                f"ignored {about}: it has no positions", throttle_duration_sec=COMPLAINT_INTERVAL_S
            )
            return
        self._complain(f"{about}: {len(state.names)} names, but {len(state.positions)} positions")

    def _complain(self, about: str) -> None:
        self.get_logger().error(f"ignored {about}", throttle_duration_sec=COMPLAINT_INTERVAL_S)
