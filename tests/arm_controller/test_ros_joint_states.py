"""Joint states are kept by name, never by index; silence is reported once."""

from types import SimpleNamespace

import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

from arm_controller import ros_joint_states
from arm_controller.ros_joint_states import PATIENCE_S, JointReadings


class Topic:
    """A node whose /joint_states has these messages, and what it logs."""

    def __init__(self, monkeypatch) -> None:
        self.now_s = 0.0
        self.warnings: list[str] = []
        monkeypatch.setattr(ros_joint_states, "time", SimpleNamespace(monotonic=lambda: self.now_s))
        self.states = JointReadings(self)  # pyright: ignore[reportArgumentType]
        self._pending: list[bytes] = []
        monkeypatch.setattr(
            self.states,
            "_polled",
            SimpleNamespace(take=lambda *_: [(m, {}) for m in self._taken()]),
        )

    def create_subscription(self, *_: object, **__: object) -> None:
        pass

    def get_logger(self) -> SimpleNamespace:
        return SimpleNamespace(warning=self.warnings.append)

    def _taken(self) -> list[bytes]:
        pending, self._pending = self._pending, []
        return pending

    def say(self, *messages: JointState) -> bool:
        self._pending = [serialize_message(message) for message in messages]
        return self.states.take()


@pytest.fixture
def topic(monkeypatch) -> Topic:
    return Topic(monkeypatch)


def test_the_order_of_a_message_does_not_matter(topic):
    names, positions = ["j1", "j0"], [1.0, -0.5]
    assert topic.say(JointState(name=names, position=positions, velocity=[11, 10], effort=[21, 20]))
    assert topic.states.figures("j0") == {
        "position": "-0.500000",
        "velocity": "10.000000",
        "effort": "20.000000",
    }


def test_messages_of_several_sources_complete_each_other(topic):
    topic.say(
        JointState(name=["j0", "j1"], position=[0.0, 1.0], velocity=[2.0, 3.0]),
        JointState(name=["grip"], position=[5.0]),
        JointState(name=["j1"], position=[1.5]),
    )
    assert topic.states.positions == {"j0": 0.0, "j1": 1.5, "grip": 5.0}
    assert topic.states.figures("j1")["velocity"] == "unknown"
    assert topic.states.figures("j0")["velocity"] == "2.000000"


def test_a_message_with_fewer_positions_than_names_is_left_out(topic):
    assert not topic.say(JointState(name=["j0", "j1"], position=[0.0]))
    assert topic.states.positions == {}


def test_a_long_silence_is_reported_once_and_the_next_one_again(topic):
    for now_s, count in ((4.9, 0), (PATIENCE_S, 1), (200.0, 1)):
        topic.now_s = now_s
        topic.say()
        assert len(topic.warnings) == count
    assert topic.warnings[0].startswith("/joint_states has been silent for 5 s")
    topic.say(JointState())
    topic.now_s = 200.0 + PATIENCE_S
    topic.say()
    assert len(topic.warnings) == 2
