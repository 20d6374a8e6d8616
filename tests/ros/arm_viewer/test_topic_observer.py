"""The observer of topics: which rates it measures, on a node that a test makes up."""

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest
from sensor_msgs.msg import JointState

from arm_viewer.ros.graph_observer import TopicObserver

FLOAT, STATE = "std_msgs/msg/Float64", "sensor_msgs/msg/JointState"
TOPIC = "/late/joint_states"


@dataclass
class FakeNode:
    """A node in a graph where others publish every topic once."""

    publishers: list[Any] = field(default_factory=list)
    subscriptions: list[Any] = field(default_factory=list)

    def count_publishers(self, _topic: str) -> int:
        return 1

    def count_subscribers(self, topic: str) -> int:
        return sum(s.topic_name == topic for s in self.subscriptions)

    def destroy_subscription(self, subscription: Any) -> None:
        self.subscriptions.remove(subscription)

    def subscribe(self, message_class: type, topic: str, *_: object) -> Any:
        self.subscriptions.append(SimpleNamespace(topic_name=topic, msg_type=message_class))
        return self.subscriptions[-1]

    def read(self) -> list[str]:
        """Return the types of what it subscribes to."""
        return [s.msg_type.__name__ for s in self.subscriptions]


@pytest.fixture
def node():
    return FakeNode()


@pytest.fixture
def observer(node):
    made = TopicObserver(node, node)
    made.measure(True)
    return made


def test_a_topic_of_one_type_is_measured_as_long_as_it_is_wanted(node, observer):
    observer.discover({TOPIC: [FLOAT]})
    observer.discover({TOPIC: [FLOAT]})
    assert node.read() == ["Float64"]
    observer.measure(False)
    assert node.read() == []


def test_a_meter_gives_way_when_a_second_type_comes(node, observer):
    observer.discover({TOPIC: [FLOAT]})
    observer.discover({TOPIC: [STATE, FLOAT]})
    assert node.read() == []


def test_of_several_types_the_one_is_measured_that_the_node_reads(node, observer):
    node.subscribe(JointState, TOPIC)
    observer.discover({TOPIC: [FLOAT, STATE]})
    assert node.read() == ["JointState", "JointState"]


def test_a_type_that_is_not_installed_is_listed_and_not_measured(node, observer):
    observer.discover({TOPIC: ["no_such_msgs/msg/Thing"]})
    assert node.read() == []
    assert [topic.types for topic in observer.topics] == [("no_such_msgs/msg/Thing",)]
