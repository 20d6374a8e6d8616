"""The end of playing a bag, without a simulation."""

from pathlib import Path

import pytest
import zstandard
from mcap.writer import IndexType, Writer
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex

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


def plain_file(path: Path, message_encoding: str = "cdr") -> Path:
    """A file without chunks, index and repeats, whose message rosbag2 compressed."""
    with path.open("wb") as stream:
        writer = Writer(
            stream,
            index_types=IndexType.NONE,
            repeat_channels=False,
            repeat_schemas=False,
            use_chunking=False,
            use_statistics=False,
            use_summary_offsets=False,
        )
        writer.start("ros2", "somebody")
        schema = writer.register_schema(STRING, "ros2msg", b"string data")
        channel = writer.register_channel("/a", message_encoding, schema)
        data = serialize_message(String(data="from elsewhere"))
        writer.add_message(channel, START_NS, zstandard.compress(data), START_NS)
        writer.finish()
    return path


def test_a_compressed_message_of_a_file_without_a_summary_arrives(start, client, tmp_path):
    heard = client.subscribe(String, "/a", 10)
    # The delay is for a busy machine, which discovers the subscription late.
    command = start(f"arm bag play {plain_file(tmp_path / 'bag.mcap')} --delay 1")
    assert command.wait() == 0, command.err
    heard.wait_until(bool, "the message")
    assert [message.data for message in heard.messages] == ["from elsewhere"]
    assert command.err == ""


def test_messages_that_are_not_cdr_are_not_played(start, tmp_path):
    command = start(f"arm bag play {plain_file(tmp_path / 'bag.mcap', 'json')}")
    assert command.wait() == 1
    assert "/a is not played: its messages are json, not cdr\n" in command.err
    assert "nothing of " in command.err
