"""The end of playing a bag, without a simulation."""

import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from arm_cli.bag.bag_topic import BagMessage, BagTopic, find_definition
from arm_cli.bag.bag_writer import BagSettings, BagWriter
from arm_cli.bag.offered_qos import OfferedQos
from arm_cli.interfaces.index import InterfaceIndex

pytestmark = pytest.mark.ros

STRING = "std_msgs/msg/String"
START_NS = 1_700_000_000_000_000_000
DAY_NS = 86_400 * 10**9


@pytest.fixture
def bag(tmp_path):
    """Two messages on /a within a tenth of a second, and one on /b a day later."""
    writer = BagWriter(tmp_path / "bag", BagSettings())
    for name in ("/a", "/b"):
        writer.add_topic(
            BagTopic(name, STRING, "", (OfferedQos(),)), find_definition(InterfaceIndex(), STRING)
        )
    data = serialize_message(String(data="x"))
    for name, after_ns in (("/a", 0), ("/a", 10**8), ("/b", DAY_NS)):
        writer.write(BagMessage(name, START_NS + after_ns, 0, data))
    writer.close()
    return tmp_path / "bag"


def test_it_ends_after_the_last_message_of_the_selected_topics(start, bag):
    command = start(f"arm bag play {bag} --topics /a")
    assert command.wait() == 0, command.err
