"""The doctor's subscriptions to a running simulation."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String

from arm_cli.doctor.observation import ControlState, LoadedController, SetpointTopic
from arm_cli.interfaces.index import InterfaceIndex, load_class
from arm_cli.ros.clock_listener import ClockListener
from arm_cli.ros.qos import MEASURING
from arm_cli.ros.session import CommandSession

COMMAND_TYPES = (
    "std_msgs/msg/Float64",
    "std_msgs/msg/Float64MultiArray",
    "trajectory_msgs/msg/JointTrajectory",
)
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
COMMAND_NAMES = ("command", "commands", "joint_trajectory", "reference")


def command_controllers(
    topics: Mapping[str, list[str]], managers: Iterable[ControlState]
) -> dict[str, LoadedController | None]:
    """Return the set-point topics, each with its controller, or None if that is not loaded.

    A controller's topics are below its own name, as in /position_controller/commands.
    """
    loaded = {
        f"{manager.manager.rpartition('/')[0]}/{controller.name}": controller
        for manager in managers
        for controller in manager.controllers
    }
    return {
        name: loaded.get(name.rpartition("/")[0])
        for name, types in topics.items()
        if name.rpartition("/")[2] in COMMAND_NAMES
        and len(types) == 1
        and types[0] in COMMAND_TYPES
    }


class CommandListener:
    """Counts the messages of one topic, and compares the last one's stamp with the clock.

    Attributes:
        topic: the topic's absolute name.
    """

    def __init__(
        self,
        session: CommandSession,
        topic: str,
        type_name: str,
        controller: LoadedController | None,
        clock: ClockListener,
    ) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self._controller = controller
        self._clock = clock
        self._received = 0
        self._ahead_s: float | None = None
        self._lasting_s = 0.0
        message_class = load_class(InterfaceIndex().find(type_name, ("msg",)))
        session.node.create_subscription(message_class, topic, self._take, MEASURING)

    def report(self, publishers: tuple[str, ...], listeners: tuple[str, ...]) -> SetpointTopic:
        """Return the observed topic with its publishers and subscribers."""
        return SetpointTopic(
            self.topic,
            publishers,
            listeners,
            controller=self._controller.name if self._controller else "",
            state=self._controller.state if self._controller else "",
            received=self._received,
            ahead_s=self._ahead_s,
            lasting_s=self._lasting_s,
        )

    def _take(self, message: Any) -> None:
        self._received += 1
        header = getattr(message, "header", None)
        stamp_s = header.stamp.sec + header.stamp.nanosec * 1e-9 if header else 0.0
        # A stamp of 0 means "now".
        self._ahead_s = stamp_s - self._clock.now_s if stamp_s and self._clock.has_begun else None
        times = [p.time_from_start for p in getattr(message, "points", ())]
        self._lasting_s = max((t.sec + t.nanosec * 1e-9 for t in times), default=0.0)


class JointStateListener:
    """Counts the joint states of one topic.

    Attributes:
        topic: the topic's absolute name.
        received: the number of messages received.
    """

    def __init__(self, session: CommandSession, topic: str) -> None:
        """Subscribe with the session's node."""
        self.topic = topic
        self.received = 0
        self._last = b""
        session.node.create_subscription(JointState, topic, self._take, MEASURING, raw=True)

    def not_numbers(self) -> tuple[str, ...]:
        """Return the NaN values of the last message, as interfaces such as 'j0/position'."""
        if not self.received:
            return ()
        message = deserialize_message(self._last, JointState)
        values = {
            "position": message.position,
            "velocity": message.velocity,
            "effort": message.effort,
        }
        return tuple(
            f"{joint}/{kind}"
            for kind, numbers in values.items()
            for joint, number in zip(message.name, numbers, strict=False)
            if math.isnan(number)
        )

    def _take(self, message: bytes) -> None:
        self.received += 1
        self._last = message


class DescriptionListener:
    """Waits for a robot description.

    Attributes:
        topic: the topic's absolute name.
        text: the description, empty until it arrives.
    """

    def __init__(self, session: CommandSession, topic: str) -> None:
        """Subscribe with transient_local durability, as late joiners do."""
        self.topic = topic
        self.text = ""
        session.node.create_subscription(String, topic, self._take, LATCHED)

    def _take(self, message: String) -> None:
        self.text = message.data


class StopListener:
    """Listens to whether an emergency stop is latched."""

    def __init__(self, session: CommandSession, topic: str) -> None:
        self.topic = topic
        self.is_heard = self.is_engaged = False

        def take(message: Bool) -> None:
            self.is_heard, self.is_engaged = True, message.data

        session.node.create_subscription(Bool, topic, take, LATCHED)
