"""What active controllers are told, from the topics that say so."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64MultiArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import TopicTypes
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.ros.topic_types import topics_of
from arm_viewer.snapshot import Controller

_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


class CommandObserver:
    """Keeps the newest command of every interface that an active controller claims.

    By namespace: robots of one kind have joints of the same names.
    """

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
        self.commands: Mapping[str, Mapping[str, float]] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Follow the topics of active controllers; forget what others were told."""
        active = [c for c in self._controllers() if c.state == "active"]
        self._forget_all_but({(c.namespace, name) for c in active for name in c.claimed})
        prefixes = [_prefix(controller) for controller in active]
        _follow(
            self._arrays,
            {f"{p}/commands" for p in prefixes} & topics_of(Float64MultiArray, topics, self._node),
            lambda topic: self._reader(Float64MultiArray, topic),
        )
        states = {f"{p}/controller_state" for p in prefixes}
        _follow(
            self._trajectories,
            states & topics_of(JointTrajectoryControllerState, topics, self._node),
            lambda topic: self._reader(JointTrajectoryControllerState, topic),
        )

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        for controller in self._controllers():
            new = {**self._told_by_array(controller), **self._told_by_trajectory(controller)}
            if new:
                namespace = controller.namespace
                told = MappingProxyType({**self.commands.get(namespace, {}), **new})
                self.commands = MappingProxyType({**self.commands, namespace: told})

    def _forget_all_but(self, claimed: set[tuple[str, str]]) -> None:
        kept = {
            namespace: {name: told[name] for name in told if (namespace, name) in claimed}
            for namespace, told in self.commands.items()
        }
        self.commands = MappingProxyType(kept)

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

    def _reader(self, message_class: type, topic: str) -> TopicReader[Any]:
        return TopicReader(self._node, self._polled, message_class, topic, _QOS)


def _prefix(controller: Controller) -> str:
    return f"{controller.namespace}/{controller.name}"


def _follow(
    readers: dict[str, TopicReader[Any]],
    wanted: set[str],
    make: Callable[[str], TopicReader[Any]],
) -> None:
    for topic in readers.keys() - wanted:
        readers.pop(topic).close()
    for topic in wanted - readers.keys():
        readers[topic] = make(topic)
