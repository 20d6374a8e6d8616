"""The publisher of /clock: when it publishes, and its warnings about other publishers."""

from dataclasses import dataclass, field
from types import SimpleNamespace

from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from arm_control.loop.outbox import Outbox
from arm_gazebo.ros.clock_publisher import RosClockPublisher


@dataclass
class FakeNode:
    """A node in a graph that the test makes up: who publishes the time."""

    publishers: list[str] = field(default_factory=lambda: ["/arm_gazebo"])
    sent: list[bytes] = field(default_factory=list)
    subscribers: int = 1

    def create_publisher(self, _type: type, topic: str, _qos: object) -> SimpleNamespace:
        return SimpleNamespace(
            topic_name=topic,
            publish=self.sent.append,
            handle=SimpleNamespace(publish_raw=self.sent.append),
            get_subscription_count=lambda: self.subscribers,
        )

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


def test_a_single_clock_causes_no_warning():
    node = FakeNode()
    clock = RosClockPublisher(node, Outbox())
    assert clock.take_warning() is None


def test_a_time_is_published_with_the_rest_of_the_tick():
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


def test_a_time_without_subscribers_is_not_serialised():
    node = FakeNode(subscribers=0)
    outbox = Outbox()
    clock = RosClockPublisher(node, outbox)
    clock.publish(1.5)
    outbox.send()
    assert node.sent == []
    assert clock.now_s() == 1.5


def test_there_is_no_warning_before_its_own_publisher_is_discovered():
    node = FakeNode(publishers=[])
    clock = RosClockPublisher(node, Outbox())
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo"]
    assert clock.take_warning() is None


def test_each_additional_clock_is_reported_once_and_again_after_it_returns():
    node = FakeNode()
    clock = RosClockPublisher(node, Outbox())
    node.publishers = ["/arm_gazebo", "/other/player"]
    assert clock.take_warning() == (
        "/clock has 2 publishers: /arm_gazebo, /other/player; time jumps back and forth. Is "
        "another simulation running? End it, or give one of them another ROS_DOMAIN_ID"
    )
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo"]
    assert clock.take_warning() is None
    node.publishers = ["/arm_gazebo", "/other/player"]
    assert "2 publishers" in (clock.take_warning() or "")
