"""A one-shot command waits for its addressee."""

from types import SimpleNamespace

import pytest

from arm_controller import ros_arm
from arm_controller.ros_arm import CONTROLLER, OTHERS, OTHERS_WAIT_S, SETTLE_S, MatchedPublisher

ADDRESSEE = "/position_controller"


class Graph:
    """A node with one publisher, its subscribers, and the time."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self._names: set[str] = set()
        self.publisher = MatchedPublisher(self, object, "commands")

    def create_publisher(self, *_: object) -> SimpleNamespace:
        return SimpleNamespace(
            topic_name=f"{ADDRESSEE}/commands",
            get_subscription_count=lambda: len(self._names),
            publish=None,
        )

    def get_subscriptions_info_by_topic(self, _topic: str) -> list[SimpleNamespace]:
        return [
            SimpleNamespace(node_namespace="/", node_name=name.lstrip("/")) for name in self._names
        ]

    def at(self, now_s: float, *names: str) -> MatchedPublisher:
        """Return the publisher, as it sees these subscribers at this time."""
        self.now_s, self._names = now_s, set(names)
        self.publisher.observe()
        return self.publisher


@pytest.fixture
def graph(monkeypatch) -> Graph:
    clock = SimpleNamespace(monotonic=lambda: made.now_s if made else 0.0)
    made = None
    monkeypatch.setattr(ros_arm, "time", clock)
    made = Graph()
    return made


def test_it_is_never_ready_without_a_subscriber(graph):
    assert not graph.at(100.0).is_ready
    assert graph.publisher.silence_s == graph.publisher.unchanged_s == 100.0
    assert graph.publisher.describe_subscribers() == f"nobody listens on {ADDRESSEE}/commands"


def test_the_controller_is_ready_once_the_match_has_settled(graph):
    graph.at(1.0, ADDRESSEE)
    assert not graph.at(1.0 + SETTLE_S - 0.01, ADDRESSEE).is_ready
    assert graph.at(1.0 + SETTLE_S + 0.01, ADDRESSEE, "/echo").is_ready
    assert graph.publisher.silence_s == 0.0
    assert graph.publisher.describe_subscribers().startswith(f"{ADDRESSEE} listens on")


def test_another_subscriber_does_not_use_up_the_command_while_the_controller_starts(graph):
    graph.at(0.0, "/recorder")
    assert not graph.at(OTHERS_WAIT_S - 0.01, "/recorder").is_ready
    assert not graph.at(4.999, "/recorder", ADDRESSEE).is_ready
    assert graph.at(5.2, "/recorder", ADDRESSEE).is_ready
    assert graph.publisher.subscribers == CONTROLLER


def test_a_lone_listener_of_another_name_gets_the_command_in_the_end(graph):
    graph.at(0.0, "/b", "/a")
    assert graph.at(OTHERS_WAIT_S, "/b", "/a").is_ready
    assert graph.publisher.subscribers == OTHERS
    assert (
        graph.publisher.describe_subscribers()
        == f"{ADDRESSEE} does not listen on {ADDRESSEE}/commands, only /a, /b"
    )


def test_a_controller_that_returns_needs_the_settling_time_again(graph):
    graph.at(0.0, ADDRESSEE)
    graph.at(10.0)
    graph.at(11.0, ADDRESSEE)
    assert not graph.at(11.1, ADDRESSEE).is_ready
    assert graph.at(11.3, ADDRESSEE).is_ready
