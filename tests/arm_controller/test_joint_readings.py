"""Joint states are kept by name, never by index; silence is reported once."""

from math import isnan
from types import SimpleNamespace

import pytest
from sensor_msgs.msg import JointState

from arm_controller import ros_arm
from arm_controller.ros_arm import SILENCE_S, JointReadings


class Topic:
    """A node that hears what a test says, the time, and what is logged."""

    def __init__(self, monkeypatch) -> None:
        self.now_s = 0.0
        self.warnings: list[str] = []
        monkeypatch.setattr(ros_arm, "time", SimpleNamespace(monotonic=lambda: self.now_s))
        self.readings = JointReadings(self)  # pyright: ignore[reportArgumentType]

    def create_subscription(self, _type: object, _name: str, take, _qos: object) -> None:
        self.say = take

    def get_logger(self) -> SimpleNamespace:
        return SimpleNamespace(warning=self.warnings.append)


@pytest.fixture
def topic(monkeypatch) -> Topic:
    return Topic(monkeypatch)


def test_the_order_of_a_message_does_not_matter(topic):
    names, positions = ["j1", "j0"], [1.0, -0.5]
    topic.say(JointState(name=names, position=positions, velocity=[11, 10], effort=[21, 20]))
    assert topic.readings.states["j0"] == (-0.5, 10.0, 20.0)


def test_messages_of_several_sources_complete_each_other(topic):
    topic.say(JointState(name=["j0", "j1"], position=[0.0, 1.0], velocity=[2.0, 3.0]))
    topic.say(JointState(name=["grip"], position=[5.0]))
    topic.say(JointState(name=["j1"], position=[1.5]))
    states = topic.readings.states
    assert {name: state[0] for name, state in states.items()} == {"j0": 0, "j1": 1.5, "grip": 5}
    assert isnan(states["j1"][1])
    assert states["j0"][1] == 2.0


def test_a_message_with_fewer_positions_than_names_has_none(topic):
    topic.say(JointState(name=["j0", "j1"], position=[0.0]))
    assert all(isnan(state[0]) for state in topic.readings.states.values())


def test_news_are_news_once(topic):
    assert not topic.readings.has_news()
    topic.say(JointState(name=["j0"], position=[0.0]))
    assert [topic.readings.has_news() for _ in range(2)] == [True, False]


def test_a_long_silence_is_reported_once_and_the_next_one_again(topic):
    for now_s, count in ((4.9, 0), (SILENCE_S, 1), (200.0, 1)):
        topic.now_s = now_s
        topic.readings.has_news()
        assert len(topic.warnings) == count
    assert topic.warnings[0].startswith("/joint_states has been silent for 5 s")
    topic.say(JointState())
    topic.now_s = 200.0 + SILENCE_S
    topic.readings.has_news()
    assert len(topic.warnings) == 2
