"""Observe the emergency stops of all robots; engage and release them."""

import math
from collections.abc import Mapping
from types import MappingProxyType

from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import LATCHED
from arm_viewer.requests import SetEmergencyStop
from arm_viewer.ros.observer import Observer, TopicTypes, served
from arm_viewer.ros.run_commander import ControlAnswers
from arm_viewer.ros.topic_reader import TopicGroup

SERVICE = "/emergency_stop"
SERVICE_TYPE = "std_srvs/srv/SetBool"
ACTIVE = "emergency_stop/active"
ANSWER_S = 3.0
"""A stop that is not confirmed within this time is reported."""


class StopObserver(Observer):
    """Keeps whether each emergency stop is engaged, whoever engaged it.

    Attributes:
        stops: whether it is engaged, by namespace: "/left", or "" for the root namespace.
    """

    def __init__(self, node: Node, polled: PolledSubscriptions, answers: ControlAnswers) -> None:
        """Subscribe in the root namespace; problems go to `answers`."""
        self._node = node
        self._answers = answers
        self._topics = TopicGroup(node, polled, Bool, ACTIVE, LATCHED)
        self._received_s: dict[str, float] = {}
        self._clients: dict[str, Client] = {}
        self._pending: dict[Future, tuple[str, float]] = {}
        self.stops: Mapping[str, bool] = MappingProxyType({})

    def discover(self, topics: TopicTypes) -> None:
        """Look for new and disappeared emergency stops."""
        self._topics.discover(topics)
        found = {f"{name}{SERVICE}" for name in served(self._node, SERVICE, SERVICE_TYPE)}
        for service in self._clients.keys() - found:
            self._node.destroy_client(self._clients.pop(service))
        for service in found - self._clients.keys():
            self._clients[service] = self._node.create_client(SetBool, service)

    def collect(self, now_s: float) -> None:
        """Take what has arrived, forget what is outdated, and report what is not answered."""
        for reader in self._topics.readers():
            namespace, message = reader.topic.removesuffix(f"/{ACTIVE}"), reader.take_newest()
            if message is not None:
                self._received_s[namespace] = now_s
                self.stops = MappingProxyType({**self.stops, namespace: message.data})
            elif self._received_s.get(namespace, math.inf) < reader.outdated_before(now_s):
                del self._received_s[namespace]
                self.stops = MappingProxyType(
                    {name: active for name, active in self.stops.items() if name != namespace}
                )
        for future, (service, sent_s) in list(self._pending.items()):
            if not sent_s:
                self._pending[future] = service, now_s
            elif now_s - sent_s > ANSWER_S:
                del self._pending[future]
                if service in self._clients:
                    self._clients[service].remove_pending_request(future)
                self._answers.add(f"{service} did not answer within {ANSWER_S:g} s", False)

    def serve(self, request: SetEmergencyStop) -> None:
        """Call every emergency stop, whatever was called before."""
        if not self._clients:
            self._answers.add("No robot offers an emergency stop", False)
        for service, client in self._clients.items():
            future = client.call_async(SetBool.Request(data=request.engaged))
            self._pending[future] = service, 0.0
            future.add_done_callback(self._take)

    def _take(self, future: Future) -> None:
        if future not in self._pending:
            return
        service, _ = self._pending.pop(future)
        answer = future.result()
        if answer is None or not answer.success:
            reason = "" if answer is None else answer.message
            self._answers.add(f"{service}: {reason or 'refused'}", False)
        else:
            self._answers.add("", True)
