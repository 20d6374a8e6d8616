from types import SimpleNamespace

import pytest

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.ros.world_markers import watched_publisher


class Node:
    """A node that keeps the callback of its timer."""

    def create_timer(self, _period_s, callback, clock):
        self.tick, self.clock = callback, clock
        return SimpleNamespace(cancel=lambda: None)

    def create_publisher(self, *_, event_callbacks):
        return event_callbacks


def test_markers_wait_quietly_for_a_simulation_that_does_not_respond():
    asked = []

    def check():
        asked.append("where things are")
        raise RequestError(Refusal.FAILED, "the simulation did not respond within 5 s")

    node = Node()
    watched_publisher(node, "world_markers", check, lambda: None)
    node.tick()
    node.tick()
    assert len(asked) == 2


def test_other_errors_of_markers_are_not_hidden():
    def check():
        raise ValueError("shapes")

    node = Node()
    watched_publisher(node, "world_markers", check, lambda: None)
    with pytest.raises(ValueError, match="shapes"):
        node.tick()
