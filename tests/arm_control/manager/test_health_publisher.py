"""When the health report goes out."""

import threading
from collections.abc import Callable
from dataclasses import replace

import pytest

from arm_control.manager.ros.controller_manager_node import HealthPublisher
from arm_control.manager.settings import DiagnosticUpdater, ManagerSettings

pytestmark = pytest.mark.ros

PATIENCE_S = 30.0


class FakeNode:
    """A stand-in for the manager's node; `published` is set with each report."""

    def __init__(self, period_s: float) -> None:
        self.published = threading.Event()
        self.asked = threading.Event()
        self.set_period(period_s)

    def set_period(self, period_s: float) -> None:
        updater = DiagnosticUpdater(period=period_s)
        self._settings = replace(ManagerSettings(), diagnostic_updater=updater)

    @property
    def settings(self) -> ManagerSettings:
        self.asked.set()
        return self._settings

    def create_publisher(self, *_arguments: object) -> "FakeNode":
        return self

    def publish(self, _message: object) -> None:
        self.published.set()

    def get_name(self) -> str:
        return "controller_manager"

    def stamp(self) -> object:
        from builtin_interfaces.msg import Time

        return Time()


@pytest.fixture
def make_health(request) -> Callable[[FakeNode], HealthPublisher]:
    def make(node: FakeNode) -> HealthPublisher:
        health = HealthPublisher(
            node,  # pyright: ignore[reportArgumentType]
            lambda: node.settings,  # pyright: ignore[reportArgumentType]
            node.stamp,  # pyright: ignore[reportArgumentType]
        )
        health.start()
        request.addfinalizer(health.stop)
        return health

    return make


@pytest.mark.parametrize("period_s", [1e5, float("inf")])
def test_a_period_of_any_length_can_be_taken_back(make_health, period_s):
    node = FakeNode(period_s)
    make_health(node)
    assert node.asked.wait(PATIENCE_S), "the wait has begun"
    assert not node.published.is_set()

    node.set_period(0.01)
    assert node.published.wait(PATIENCE_S)
    node.published.clear()
    assert node.published.wait(PATIENCE_S), "one report after the other"


def test_a_stop_does_not_wait_for_the_period(make_health):
    node = FakeNode(float("inf"))
    health = make_health(node)
    assert node.asked.wait(PATIENCE_S)
    health.stop()

    assert not node.published.is_set()
