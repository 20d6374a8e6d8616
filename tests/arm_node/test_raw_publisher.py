"""Publishing serialised messages: received like rclpy's own, refused once the publisher is gone."""

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from arm_node.raw_publisher import RawPublisher

WAIT_TIMEOUT_S = 20.0

pytestmark = pytest.mark.ros


@pytest.fixture
def node() -> Iterator[Node]:
    with Context() as context:
        node = Node("raw_publisher", context=context)
        yield node
        node.destroy_node()


def test_a_subscriber_is_seen_and_gets_the_message(node):
    received = rclpy.Future()
    publisher = RawPublisher(node.create_publisher(String, "raw", 1))
    assert not publisher.wanted()
    node.create_subscription(String, "raw", received.set_result, 1)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    # Asked while the executor turns: end points of one participant find each other by themselves.
    timer = node.create_timer(
        0.01, lambda: publisher.wanted() and publisher.publish(serialize_message(String(data="a")))
    )
    executor.spin_until_future_complete(received, WAIT_TIMEOUT_S)
    timer.cancel()
    executor.shutdown()
    assert received.result() == String(data="a")


def test_a_destroyed_publisher_is_an_error(node):
    publisher = node.create_publisher(String, "raw", 1)
    raw = RawPublisher(publisher)
    node.destroy_publisher(publisher)
    with pytest.raises(RuntimeError, match="publisher pointer is invalid"):
        raw.publish(serialize_message(String()))
