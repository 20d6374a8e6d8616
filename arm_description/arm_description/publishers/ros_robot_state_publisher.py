"""The node robot_state_publisher: publishes /tf and /tf_static from joint states and a URDF."""

import math
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
from geometry_msgs.msg import TransformStamped
from numpy.typing import NDArray
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSPolicyKind, QoSProfile, qos_profile_sensor_data
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from arm_description.errors import DescriptionError, SettingsError
from arm_description.kinematics.forward import Frame, Motion, TransformTree
from arm_description.publishers.settings import StatePublisherSettings
from arm_description.urdf.parser import parse_urdf
from arm_node.executor_thread import ExecutorThread
from arm_node.frozen import frozen
from arm_node.names import listing
from arm_node.parameters import check_changes, declare_setting, given_parameters
from arm_node.printable import printable
from arm_node.qos import LATCHED
from arm_node.setting import settings_of
from arm_node.user_file import read_text
from arm_node.workarounds.clocks import StampClock
from arm_node.workarounds.joint_state_encoding import (
    NANOSECONDS,
    EncodingError,
    JointPositions,
    read_joint_state,
)
from arm_node.workarounds.message_template import MessageTemplate


class _TransformPublisher:
    """Publishes a TFMessage with constant frames. One thread at a time."""

    def __init__(self, publisher: Publisher, frames: Sequence[Frame], prefix: str) -> None:
        """Create the message template.

        Args:
            publisher: publishes TFMessage.
            frames: child frames and their parents.
            prefix: prefix of every frame's name.
        """
        self._publisher = publisher
        self._template = MessageTemplate(
            TFMessage(transforms=[_transform_stamped(frame, prefix) for frame in frames])
        )
        self._where = self._template.indices("transforms[*].transform")

    def publish(self, transforms: NDArray[np.float64], stamp_ns: int) -> None:
        """Publish (m, 7): x, y, z in m and the quaternion x, y, z, w of every frame."""
        self._template.set_stamps(stamp_ns)
        self._template.float64[self._where] = transforms.ravel()
        self._template.publish(self._publisher)


def _transform_stamped(frame: Frame, prefix: str) -> TransformStamped:
    message = TransformStamped()
    message.header.frame_id = prefix + frame.parent
    message.child_frame_id = prefix + frame.child
    return message


MAX_INTERVAL_MS = 1e13
"""Longer than any stamp, so that at an extremely low frequency no joint state is used."""
LOG_INTERVAL_S = 5.0
MAX_GROUPS = 32
"""Maximum sets of joint names whose message templates are kept."""

_TF_QOS = QoSProfile(depth=100)


class StateThrottle:
    """Accepts a joint state if its stamp is one interval after the last ones of its joints.

    As in robot_state_publisher, the joint with the oldest stamp decides, so two publishers of
    different joints do not throttle each other. A stamp that does not advance is never accepted.
    One thread at a time.
    """

    def __init__(self, frequency_hz: float) -> None:
        """Throttle to a frequency; 0 accepts every stamp that is not older than the last."""
        self._interval_ns = 0
        self._published_ns: dict[str, int] = {}
        self._now_ns = 0
        self.set_frequency(frequency_hz)

    def set_frequency(self, frequency_hz: float) -> None:
        """Set the maximum frequency; it takes effect with the next message."""
        # Whole milliseconds as in ROS 2: 30 Hz in, 30 Hz out, despite jitter below 0.3 ms.
        interval_ms = min(1000.0 / frequency_hz, MAX_INTERVAL_MS) if frequency_hz else 0.0
        self._interval_ns = int(interval_ms) * 1_000_000

    def went_back(self, now_ns: int) -> bool:
        """Record the node's time; return whether it went back, which resets the throttle."""
        back = now_ns < self._now_ns
        if back:
            self._published_ns.clear()
        self._now_ns = now_ns
        return back

    def due(self, names: Sequence[str], stamp_ns: int) -> bool:
        """Return whether to use a message with this stamp about these joints."""
        oldest = self._now_ns
        for name in names:
            oldest = min(oldest, self._published_ns.get(name, 0))
        return stamp_ns >= oldest + self._interval_ns

    def record_used(self, names: Sequence[str], stamp_ns: int) -> None:
        """Record that a message was used."""
        self._published_ns.update(dict.fromkeys(names, stamp_ns))


@frozen
class _TransformGroup:
    """The transforms of joint states that name the same joints."""

    names: tuple[str, ...]
    motion: Motion
    publisher: _TransformPublisher


class RobotStatePublisher(Node):
    """Publishes the poses of the links; every callback runs in the executor's thread.

    Args:
        namespace: namespace of the node; an argument __ns of the process takes its place.
        urdf_file: the file that robot_description comes from if that parameter is empty.

    Raises:
        SettingsError: a parameter is invalid, for example an empty robot_description.
        XmlError, UrdfError: the description is not a robot.
    """

    def __init__(self, namespace: str = "", urdf_file: str | None = None) -> None:
        super().__init__("robot_state_publisher", namespace=namespace)
        self._stamp_clock = StampClock(self)
        given = given_parameters(self)
        if urdf_file is not None and not given.get("robot_description"):
            given["robot_description"] = self._text_of(urdf_file)
        self._settings = StatePublisherSettings.from_parameters(given)
        for each in settings_of(StatePublisherSettings):
            declare_setting(self, each, given)
        self._tree = TransformTree(parse_urdf(self._settings.robot_description))
        self._moved_back_s = -math.inf
        self._throttle = StateThrottle(self._settings.publish_frequency_hz)
        self._groups: dict[tuple[str, ...], _TransformGroup] = {}
        self._description_publisher = self.create_publisher(String, "robot_description", LATCHED)
        policies = (QoSPolicyKind.DEPTH, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY)
        self._static_publisher = self.create_publisher(
            TFMessage,
            "/tf_static",
            LATCHED,
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
        # After all declarations, because the callbacks would also receive those of QoS overrides.
        check_changes(self, self._check_changes, DescriptionError)
        self.add_post_set_parameters_callback(self._take_parameters)
        self._publish_description()
        self._publish_static()

    def _text_of(self, path: str) -> str:
        """Return the description in a file that an argument names.

        Raises:
            SettingsError: the file cannot be read.
        """
        self.get_logger().warning(
            "No robot_description parameter, but command-line argument available.  Assuming "
            "argument is name of URDF file.  This backwards compatibility fallback will be "
            "removed in the future."
        )
        try:
            return read_text(path)
        except (OSError, UnicodeError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise SettingsError(f"Failed to open URDF file: {path}: {reason}") from error

    def _checked(self, changes: Sequence[Parameter]) -> StatePublisherSettings:
        names = [each.name for each in settings_of(StatePublisherSettings)]
        values = {name: self.get_parameter(name).value for name in names}
        values.update((change.name, change.value) for change in changes)
        return StatePublisherSettings.from_parameters(values)

    def _check_changes(self, changes: list[Parameter]) -> None:
        settings = self._checked(changes)
        if settings.robot_description != self._settings.robot_description:
            parse_urdf(settings.robot_description)

    def _take_parameters(self, _changes: list[Parameter]) -> None:
        before, self._settings = self._settings, self._checked(())
        self._throttle.set_frequency(self._settings.publish_frequency_hz)
        if self._settings.robot_description != before.robot_description:
            self._tree = TransformTree(parse_urdf(self._settings.robot_description))
            self._publish_description()
        elif self._settings.frame_prefix == before.frame_prefix:
            return
        self._groups.clear()
        self._publish_static()

    def _publish_description(self) -> None:
        self._description_publisher.publish(String(data=self._settings.robot_description))

    def _publish_static(self) -> None:
        # One message with all frames, because late subscribers get only the latest message.
        _TransformPublisher(
            self._static_publisher, self._tree.static_frames, self._settings.frame_prefix
        ).publish(self._tree.static_transforms, self._now_ns())

    def _now_ns(self) -> int:
        return self.get_clock().now().nanoseconds

    def _on_joint_state(self, data: bytes) -> None:
        try:
            state = read_joint_state(data)
        except EncodingError as error:
            self._report(f"a JointState whose bytes cannot be read: {error}")
            return
        if len(state.names) != len(state.positions):
            self._report_sizes(state)
            return
        if state.stamp_ns < 0:
            stamp_s = state.stamp_ns / NANOSECONDS
            about = f"a JointState about {listing(state.names)}"
            self._report(f"{about}: its stamp, {stamp_s:g} s, is negative")
            return
        self._stamp_clock.hear(state.names, state.stamp_ns)
        if self._throttle.went_back(self.get_clock().now().nanoseconds):
            self._say_moved_back()
        group = self._group_of(state.names)
        if not group.names:
            return
        if self._settings.ignore_timestamp or self._throttle.due(group.names, state.stamp_ns):
            self._publish(group, state)

    def _say_moved_back(self) -> None:
        """Log it, but once as long as it goes on: beside a bag, each other message is older."""
        now_s = time.monotonic()
        if now_s - self._moved_back_s > LOG_INTERVAL_S:
            self.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
        self._moved_back_s = now_s

    def _publish(self, group: _TransformGroup, state: JointPositions) -> None:
        transforms = group.motion.transforms(state.positions)
        finite = np.isfinite(transforms).all(axis=1)
        if not finite.all():
            child = group.motion.frames[int(np.argmin(finite))].child
            self._report(
                f"a JointState about {listing(group.names)}: a position is not a finite number, "
                f"or too large for link {child!r}"
            )
            return
        group.publisher.publish(transforms, state.stamp_ns)
        self._throttle.record_used(group.names, state.stamp_ns)

    def _group_of(self, names: tuple[str, ...]) -> _TransformGroup:
        group = self._groups.get(names)
        if group is None:
            if len(self._groups) >= MAX_GROUPS:
                self._groups.clear()
            group = self._groups[names] = self._lay_out(names)
        return group

    def _lay_out(self, names: tuple[str, ...]) -> _TransformGroup:
        motion = self._tree.motion(names)
        return _TransformGroup(
            names=tuple(names[source] for source in dict.fromkeys(motion.source.tolist())),
            motion=motion,
            publisher=_TransformPublisher(
                self._tf_publisher, motion.frames, self._settings.frame_prefix
            ),
        )

    def _report_sizes(self, state: JointPositions) -> None:
        about = printable(f"a JointState about {listing(state.names)}")
        if len(state.positions) == 0:
            # A message with only velocities is valid, but the warning explains why nothing moves.
            self.get_logger().warning(
                f"ignored {about}: it has no positions", throttle_duration_sec=LOG_INTERVAL_S
            )
            return
        self._report(f"{about}: {len(state.names)} names, but {len(state.positions)} positions")

    def _report(self, about: str) -> None:
        text = printable(f"ignored {about}")
        self.get_logger().error(text, throttle_duration_sec=LOG_INTERVAL_S)


MAX_WAIT_S = 1.0
"""Without a timeout, spin_once of this executor polls the clock while it holds the GIL."""


@contextmanager
def spinning(*nodes: Node) -> Iterator[None]:
    """Run the nodes' callbacks in a separate thread; at the end stop it and destroy the nodes."""
    thread = ExecutorThread("events", EventsExecutor(context=nodes[0].context), MAX_WAIT_S)
    for node in nodes:
        thread.executor.add_node(node)
    thread.start()
    try:
        yield
    finally:
        thread.stop()
        for node in nodes:
            node.destroy_node()
