"""Publishes a replayed run: clock, joint states, transforms, shapes, contacts and more."""

import time

from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from arm_cli.ros.replayed_messages import CLOCK, CONTACTS, MARKERS, TF, ReplayedMessages
from arm_cli.ros.session import CommandSession
from arm_gazebo.recording.replay import Replay

PUBLISH_PERIOD_S = 0.02
MARKER_EVERY = 5
"""Shapes and contacts are looked at with every fifth state."""
HOLD_PERIOD_S = 0.1
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class RunPlayer:
    """Shows a replay to ROS tools, at a pace. Use it in the session's thread.

    Args:
        session: its node publishes.
        replay: the replay, before its first period.
        speed: simulated seconds for each second of wall time.
    """

    def __init__(self, session: CommandSession, replay: Replay, speed: float) -> None:
        node = session.node
        self._session = session
        self._replay = replay
        self._speed = speed
        self._messages = ReplayedMessages(replay)
        self._clock = node.create_publisher(Clock, CLOCK, 10)
        self._transforms = node.create_publisher(TFMessage, TF, 100)
        self._markers = node.create_publisher(MarkerArray, MARKERS, LATCHED)
        self._contacts = node.create_publisher(MarkerArray, CONTACTS, LATCHED)
        for topic, text in self._messages.descriptions().items():
            node.create_publisher(String, topic, LATCHED).publish(text)
        self._states = {
            topic: node.create_publisher(JointState, topic, 10)
            for topic in self._messages.joint_states()
        }
        self._started_s = time.monotonic()
        self._first_s = replay.simulation.time_s
        self._next_s = 0.0
        self._published = 0

    def show(self) -> None:
        """Publish the present state if one is due; call it after each period.

        Raises:
            StoppedError: a signal arrived.
        """
        shown_s = (self._replay.simulation.time_s - self._first_s) / self._speed
        if shown_s < self._next_s:
            return
        self._next_s = shown_s + PUBLISH_PERIOD_S
        self._publish()
        wait_s = self._started_s + shown_s - time.monotonic()
        if wait_s > 0.0:
            self._session.spin_for(wait_s)
        else:
            self._session.spin_once(0.0)

    def hold(self) -> None:
        """Publish the last state again and again, until Ctrl-C.

        Raises:
            StoppedError: a signal arrived.
        """
        while True:
            self._publish()
            self._session.spin_for(HOLD_PERIOD_S)

    def _publish(self) -> None:
        self._clock.publish(self._messages.clock())
        for topic, state in self._messages.joint_states().items():
            self._states[topic].publish(state)
        self._transforms.publish(self._messages.transforms())
        self._published += 1
        if self._published % MARKER_EVERY == 1:
            shapes, contacts = self._messages.markers(), self._messages.contacts()
            if shapes is not None:
                self._markers.publish(shapes)
            if contacts is not None:
                self._contacts.publish(contacts)
