"""When the introspection of a manager is published, without a middleware."""

import threading
from typing import Any

import numpy as np
import pytest

from arm_control.manager.introspection import ManagerSnapshot, NamedValues

pytestmark = pytest.mark.ros

PATIENCE_S = 30.0
LOOKS = 20


class FakePublisher:
    def __init__(self, subscriptions: int, looked: threading.Semaphore) -> None:
        self.messages: list[Any] = []
        self.subscriptions = subscriptions
        self._looked = looked

    def get_subscription_count(self) -> int:
        self._looked.release()
        return self.subscriptions

    def publish(self, message: Any) -> None:
        self.messages.append(message)


class FakeNode:
    """A stand-in for the manager's node; every topic has this many subscribers."""

    def __init__(self, subscriptions: int) -> None:
        self.publishers: dict[str, FakePublisher] = {}
        self.looked = threading.Semaphore(0)
        self._subscriptions = subscriptions

    def create_publisher(self, _type: Any, topic: str, _qos: Any) -> FakePublisher:
        publisher = FakePublisher(self._subscriptions, self.looked)
        self.publishers[topic] = publisher
        return publisher

    def get_name(self) -> str:
        return "controller_manager"

    def stamp(self) -> Any:
        from builtin_interfaces.msg import Time

        return Time(sec=1)


class CountedLoop:
    """Counts the calls on the loop thread."""

    calls = 0

    def call(self, _function: Any) -> Any:
        self.calls += 1
        raise AssertionError("nobody subscribes")


def test_the_loop_is_not_used_without_subscribers(bench, monkeypatch):
    from arm_control.manager.ros import introspection_publisher

    monkeypatch.setattr(introspection_publisher, "START_S", 0.0)
    monkeypatch.setattr(introspection_publisher, "WATCH_S", 0.001)
    node, loop = FakeNode(0), CountedLoop()
    publisher: Any = introspection_publisher.IntrospectionPublisher
    introspection = publisher(node, bench.manager, ManagerSnapshot(bench.manager), loop)
    introspection.start()
    for _ in range(LOOKS):
        assert node.looked.acquire(timeout=PATIENCE_S)
    introspection.stop()
    assert loop.calls == 0
    assert len(node.publishers) == 6
    assert not any(publisher.messages for publisher in node.publishers.values())


def test_while_paused_only_new_names_are_published():
    from builtin_interfaces.msg import Time

    from arm_control.manager.ros.introspection_publisher import StatisticsTopic

    sample = (Time(sec=1), NamedValues(("a",), np.array([1.0])))
    node: Any = FakeNode(1)
    topic = StatisticsTopic(node, "x", lambda: sample)
    counts: list[tuple[int, int]] = []
    for stamp_s, names in ((1, ("a",)), (1, ("a",)), (2, ("a",)), (2, ("a", "b"))):
        sample = (Time(sec=stamp_s), NamedValues(names, np.zeros(len(names))))
        topic.publish()
        counts.append(
            (len(node.publishers["x/values"].messages), len(node.publishers["x/names"].messages))
        )
    assert counts == [(1, 1), (1, 1), (2, 1), (3, 2)]
