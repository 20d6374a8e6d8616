"""Observe the commands to active controllers."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

from control_msgs.msg import JointTrajectoryControllerState
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64MultiArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import Observer, TopicTypes, keep_in_step, topics_of
from arm_viewer.ros.topic_reader import TopicReader
from arm_viewer.snapshot import ListedController

PERIOD_S = 0.09
_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


class CommandObserver(Observer):
    """Keeps the latest command of every interface that an active controller claims.

    Commands are kept by namespace, because robots of one kind have the same joint names.
    """

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        controllers: Callable[[], tuple[ListedController, ...]],
    ) -> None:
        """Observe the controllers that `controllers` returns."""
        self._node = node
        self._polled = polled
        self._controllers = controllers
        self._arrays: dict[str, TopicReader[Any]] = {}
        self._trajectories: dict[str, TopicReader[Any]] = {}
        self._collected_s = -math.inf
        self.commands: Mapping[str, Mapping[str, float]] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Follow the topics of active controllers; forget commands to other controllers."""
        active = [c for c in self._controllers() if c.state == "active"]
        self._forget_all_but({(c.namespace, name) for c in active for name in c.claimed})
        prefixes = [_prefix(controller) for controller in active]
        for kind, readers, ending in (
            (Float64MultiArray, self._arrays, "commands"),
            (JointTrajectoryControllerState, self._trajectories, "controller_state"),
        ):
            wanted = {f"{p}/{ending}" for p in prefixes} & topics_of(kind, topics, self._node)
            keep_in_step(readers, wanted, partial(self._reader, kind))

    def collect(self, now_s: float) -> None:
        """Take what has arrived, ten times a second: a trajectory controller says a lot."""
        if now_s - self._collected_s < PERIOD_S:
            return
        self._collected_s = now_s
        for controller in self._controllers():
            new = {**self._array_commands(controller), **self._trajectory_commands(controller)}
            if new:
                namespace = controller.namespace
                commands = MappingProxyType({**self.commands.get(namespace, {}), **new})
                self.commands = MappingProxyType({**self.commands, namespace: commands})

    def _forget_all_but(self, claimed: set[tuple[str, str]]) -> None:
        kept = {
            namespace: {name: commands[name] for name in commands if (namespace, name) in claimed}
            for namespace, commands in self.commands.items()
        }
        self.commands = MappingProxyType(kept)

    def _array_commands(self, controller: ListedController) -> dict[str, float]:
        reader = self._arrays.get(f"{_prefix(controller)}/commands")
        message = reader.take_newest() if reader else None
        # The controller refuses a message of another length.
        if message is None or len(message.data) != len(controller.claimed):
            return {}
        return dict(zip(controller.claimed, message.data, strict=True))

    def _trajectory_commands(self, controller: ListedController) -> dict[str, float]:
        reader = self._trajectories.get(f"{_prefix(controller)}/controller_state")
        message = reader.take_newest() if reader else None
        if message is None:
            return {}
        point = message.reference
        commands: dict[str, float] = {}
        for quantity, values in (
            ("position", point.positions),
            ("velocity", point.velocities),
            ("effort", point.effort),
        ):
            # A controller that does not command a quantity leaves it empty.
            names = (f"{joint}/{quantity}" for joint in message.joint_names)
            commands.update(zip(names, values, strict=False))
        return {name: value for name, value in commands.items() if name in controller.claimed}

    def _reader(self, message_class: type, topic: str) -> TopicReader[Any]:
        return TopicReader(self._node, self._polled, message_class, topic, _QOS)


def _prefix(controller: ListedController) -> str:
    return f"{controller.namespace}/{controller.name}"
