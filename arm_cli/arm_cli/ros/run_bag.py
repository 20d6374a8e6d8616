"""Writes a replayed run as a bag, for everything that shows bags."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex
from arm_cli.ros.replayed_messages import CLOCK, CONTACTS, MARKERS, TF, ReplayedMessages
from arm_gazebo.recording.replay import Replay
from arm_node.workarounds.message_template import serialized

SHOWN_PERIOD_S = 1.0 / 30.0
"""Between two transforms of a link, and two values of the clock."""
MARKER_PERIOD_S = 0.1
_TYPES = {
    Clock: "rosgraph_msgs/msg/Clock",
    JointState: "sensor_msgs/msg/JointState",
    String: "std_msgs/msg/String",
    TFMessage: "tf2_msgs/msg/TFMessage",
    MarkerArray: "visualization_msgs/msg/MarkerArray",
}
_LATCHED = (OfferedQos(durability="transient_local"),)


class RunBag:
    """Writes a bag whose time is that of the recording: 0 at its beginning, and never back.

    Joint states are written after each control period, so that no peak is lost; the rest as often
    as it is shown, and shapes and contacts only when they have changed.

    Args:
        folder: of the bag; it must not exist.
        replay: the replay, before its first period.

    Raises:
        BagError: the bag cannot be made.
    """

    def __init__(self, folder: Path, replay: Replay) -> None:
        self._replay = replay
        self._messages = ReplayedMessages(replay)
        self._index = InterfaceIndex()
        self._topics: set[str] = set()
        self._shown_s = self._marked_s = -np.inf
        self._writer = BagWriter(folder, BagSettings(compression="zstd"))
        self._write(self._messages.descriptions())
        self.show()

    def show(self) -> None:
        """Write the present state; call it after each period.

        Raises:
            BagError: the bag cannot be written.
        """
        time_s = self._time_s()
        self._write(self._messages.joint_states())
        if time_s >= self._shown_s + SHOWN_PERIOD_S:
            self._shown_s = time_s
            self._write({CLOCK: self._messages.clock(), TF: self._messages.transforms()})
        if time_s >= self._marked_s + MARKER_PERIOD_S:
            self._marked_s = time_s
            found = {MARKERS: self._messages.markers(), CONTACTS: self._messages.contacts()}
            self._write({topic: m for topic, m in found.items() if m is not None})

    def split(self) -> str:
        """Finish the file of what was shown so far, and begin another; return its name.

        Raises:
            BagError: the bag cannot be written.
        """
        return self._writer.split()

    def close(self) -> None:
        """Finish the bag.

        Raises:
            BagError: the bag cannot be written.
        """
        self._writer.close()

    def _time_s(self) -> float:
        # Simulation time may go back to zero.
        return self._replay.periods * self._replay.simulation.timing.period_s

    def _write(self, messages: Mapping[str, Any]) -> None:
        time_ns = round(self._time_s() * 1e9)
        for topic, message in messages.items():
            if topic not in self._topics:
                self._topics.add(topic)
                kind = _TYPES[type(message)]
                offers = _LATCHED if isinstance(message, String | MarkerArray) else (OfferedQos(),)
                definition = find_definition(self._index, kind)
                self._writer.add_topic(BagTopic(topic, kind, offers=offers), definition)
            self._writer.write(BagMessage(topic, time_ns, time_ns, serialized(message)))
