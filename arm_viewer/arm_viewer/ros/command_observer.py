"""What active controllers are told, from the topics that say so."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64MultiArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import Controller

_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
_ARRAY_TYPE = "std_msgs/msg/Float64MultiArray"
_TRAJECTORY_TYPE = "control_msgs/msg/JointTrajectoryControllerState"


class CommandObserver:
    """Keeps the newest command of every interface that an active controller claims."""

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        controllers: Callable[[], tuple[Controller, ...]],
    ) -> None:
        """Start to look at the controllers of that list."""
        self._node = node
        self._polled = polled
        self._controllers = controllers
        self._arrays: dict[str, TopicReader[Float64MultiArray]] = {}
        self._trajectories: dict[str, TopicReader[JointTrajectoryControllerState]] = {}
        self.commands: Mapping[str, float] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Follow the topics of active controllers; forget what others were told."""
        active = [c for c in self._controllers() if c.state == "active"]
        claimed = {interface for controller in active for interface in controller.claimed}
        if not claimed.issuperset(self.commands):
            kept = {name: value for name, value in self.commands.items() if name in claimed}
            self.commands = MappingProxyType(kept)
        prefixes = [_prefix(controller) for controller in active]
        _follow(
            self._arrays,
            {t for t in (f"{p}/commands" for p in prefixes) if _ARRAY_TYPE in topics.get(t, ())},
            lambda topic: self._reader(Float64MultiArray, topic),
        )
        states = (f"{p}/controller_state" for p in prefixes)
        _follow(
            self._trajectories,
            {t for t in states if _TRAJECTORY_TYPE in topics.get(t, ())},
            lambda topic: self._reader(JointTrajectoryControllerState, topic),
        )

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        new: dict[str, float] = {}
        for controller in self._controllers():
            new.update(self._told_by_array(controller))
            new.update(self._told_by_trajectory(controller))
        if new:
            self.commands = MappingProxyType({**self.commands, **new})

    def _told_by_array(self, controller: Controller) -> dict[str, float]:
        reader = self._arrays.get(f"{_prefix(controller)}/commands")
        message = reader.take_newest() if reader else None
        # One of another length is refused by the controller.
        if message is None or len(message.data) != len(controller.claimed):
            return {}
        return dict(zip(controller.claimed, message.data, strict=True))

    def _told_by_trajectory(self, controller: Controller) -> dict[str, float]:
        reader = self._trajectories.get(f"{_prefix(controller)}/controller_state")
        message = reader.take_newest() if reader else None
        if message is None:
            return {}
        point = message.reference
        told: dict[str, float] = {}
        for quantity, values in (
            ("position", point.positions),
            ("velocity", point.velocities),
            ("effort", point.effort),
        ):
            # A controller that does not command a quantity leaves it empty.
            names = (f"{joint}/{quantity}" for joint in message.joint_names)
            told.update(zip(names, values, strict=False))
        return {name: value for name, value in told.items() if name in controller.claimed}

    def _reader(self, message_class: type, topic: str) -> TopicReader:
        return TopicReader(self._node, self._polled, message_class, topic, _QOS)


def _prefix(controller: Controller) -> str:
    return f"{controller.namespace}/{controller.name}"


def _follow(
    readers: dict[str, TopicReader], wanted: set[str], make: Callable[[str], TopicReader]
) -> None:
    for topic in readers.keys() - wanted:
        readers.pop(topic).close()
    for topic in wanted - readers.keys():
        readers[topic] = make(topic)
