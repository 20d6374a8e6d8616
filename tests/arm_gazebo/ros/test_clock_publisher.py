"""The publisher of /clock: when it publishes, what it says of others that publish the time."""

from dataclasses import dataclass, field
from types import SimpleNamespace

from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_control.outbox import Outbox
from arm_gazebo.ros.clock_publisher import RosClockPublisher


@dataclass
class FakeNode:
    """A node in a graph that the test makes up: who publishes the time."""

    publishers: list[str] = field(default_factory=lambda: ["/arm_gazebo"])
    sent: list[bytes] = field(default_factory=list)
    subscribers: int = 1

    def create_publisher(self, _type: type, topic: str, _qos: object) -> SimpleNamespace:
        handle = SimpleNamespace(
            publish_raw=self.sent.append, get_subscription_count=lambda: self.subscribers
        )
        return SimpleNamespace(topic_name=topic, handle=handle)

    def count_publishers(self, topic: str) -> int:
        assert topic == "/clock"
        return len(self.publishers)

    def get_publishers_info_by_topic(self, topic: str) -> list[SimpleNamespace]:
        assert topic == "/clock"
        parts = [name.rpartition("/") for name in self.publishers]
        return [
            SimpleNamespace(node_namespace=namespace or "/", node_name=name)
            for namespace, _, name in parts
        ]


def test_the_only_clock_says_nothing():
    node = FakeNode()
    clock = RosClockPublisher(node, Outbox())
    assert clock.take_warning() is None


def test_a_time_goes_out_with_the_rest_of_the_tick():
    node = FakeNode()
    outbox = Outbox()
    clock = RosClockPublisher(node, outbox)
    clock.publish(1.5)
    assert clock.now_s() == 1.5
    assert node.sent == []
    outbox.send()
    assert [deserialize_message(data, Clock) for data in node.sent] == [
        Clock(clock=Time(sec=1, nanosec=500_000_000))
    ]


def test_a_time_that_nobody_listens_to_is_not_written():
    node = FakeNode(subscribers=0)
    outbox = Outbox()
    clock = RosClockPublisher(node, outbox)
    clock.publish(1.5)
    outbox.send()
    assert node.sent == []
    assert clock.now_s() == 1.5


def test_before_its_own_publisher_is_known_it_says_nothing():
    node = FakeNode(publishers=[])
    clock = RosClockPublisher(node, Outbox())
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo"]
    assert clock.take_warning() is None


def test_each_further_clock_is_said_once_and_again_when_it_comes_back():
    node = FakeNode()
    clock = RosClockPublisher(node, Outbox())
    node.publishers = ["/arm_gazebo", "/other/player"]
    assert clock.take_warning() == (
        "/clock has 2 publishers: /arm_gazebo, /other/player; time jumps to and fro. Does another "
        "simulation run? End it, or give one of them another ROS_DOMAIN_ID"
    )
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo"]
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo", "/other/player"]
    assert "2 publishers" in (clock.take_warning() or "")
