"""Recording a running simulation and playing it back."""

import json
import signal
import time
from itertools import pairwise
from pathlib import Path

import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from arm_cli.bag_format.reader import BagReader

pytestmark = pytest.mark.usefixtures("simulation")

RECORDED = "/joint_states /tf /tf_static /robot_description"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture(scope="module")
def bag(tmp_path_factory, start_for_file, simulation, counts) -> Path:
    """A recording of some messages of each topic."""
    folder = tmp_path_factory.mktemp("recorded") / "bag"
    command = start_for_file(f"arm bag record {RECORDED} -o {folder}")
    command.wait_for("All requested topics are subscribed")
    command.wait_until(lambda: counts(folder)["/joint_states"] >= 200, "200 joint states")
    assert command.interrupt() == 0, command.err
    assert "Recording stopped\n" in command.err
    assert "No message was dropped\n" in command.err
    return folder


def test_other_readers_find_the_published_messages(bag):
    with AnyReader([bag]) as reader:
        read = [
            (connection.topic, reader.deserialize(data, connection.msgtype))
            for connection, _, data in reader.messages()
        ]
        offers = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
    states = [message for topic, message in read if topic == "/joint_states"]
    stamps = [state.header.stamp.sec * 10**9 + state.header.stamp.nanosec for state in states]
    assert states[0].name == ["j0", "j1", "j2", "j3"]
    assert {after - before for before, after in pairwise(stamps)} == {10**7}
    # Latched before the recorder was there.
    assert [m.data[:5] for topic, m in read if topic == "/robot_description"] == ["<?xml"]
    assert offers["/tf_static"][0].durability.name == "TRANSIENT_LOCAL"


def test_info(run, bag):
    text = run(f"arm bag info {bag}")
    assert "Topic: /tf | Type: tf2_msgs/msg/TFMessage | Count: " in text
    topics = {t["name"]: t for t in json.loads(run(f"arm bag info --json {bag}"))["topics"]}
    assert topics["/joint_states"]["type_hash"].startswith("RIHS01_a13ee3a330e346c9d87b5aa18d24e11")
    assert topics.keys() == set(RECORDED.split())


def test_play_keeps_times_and_content(start, client, bag):
    played = client.subscribe(JointState, "/played", 1000)
    described = client.subscribe(String, "/described", LATCHED)
    began_s = time.monotonic()
    command = start(
        f"arm bag play {bag} --rate 0.5 --delay 2 --topics /joint_states /robot_description "
        "-m /joint_states:=/played /robot_description:=/described"
    )
    assert command.wait() == 0, command.err
    with BagReader(bag) as reader:
        recorded = list(reader.messages(["/joint_states"]))
    times_ns = [message.log_time_ns for message in recorded]
    sent = [deserialize_message(message.data, JointState) for message in recorded]
    # A slow reader may be known after the first ones, and may lose the very last ones when the
    # publisher ends before it has taken them.
    late = sent[len(sent) * 9 // 10 :]
    messages = played.wait_until(lambda m: bool(m) and m[-1] in late, "one of the last")
    first, last = sent.index(messages[0]), sent.index(messages[-1])
    assert first < len(sent) // 2
    assert messages == sent[first : last + 1]
    described.wait_for(1)
    # Never early; how late is the machine's affair.
    taken_s = played.arrivals_s[len(messages) - 1] - began_s
    assert taken_s > 2.0 + (times_ns[last] - times_ns[0]) * 1e-9 / 0.5


def test_the_clock_of_a_bag(start, client, bag):
    clock = client.subscribe(Clock, "/clock", 1000)
    # So slow that it lasts until it is discovered.
    command = start(f"arm bag play {bag} --clock 50 -m /clock:=/x --topics /tf_static --rate 0.1")
    with BagReader(bag) as reader:
        span = reader.metadata.span

    def ticks(messages: list[Clock]) -> list[int]:
        times_ns = [m.clock.sec * 10**9 + m.clock.nanosec for m in messages]
        # The simulation's own clock has not come so far.
        return [time_ns for time_ns in times_ns if time_ns >= span.start_ns]

    messages = clock.wait_until(lambda m: len(ticks(m)) >= 20, "20 ticks of the bag's clock")
    found = ticks(messages)
    assert found == sorted(found)
    assert found[-1] <= span.end_ns + 10**9
    command.process.send_signal(signal.SIGTERM)
    assert command.wait() == 0, command.err


def test_play_in_a_loop_from_an_offset_until_ctrl_c(start, client, bag):
    played = client.subscribe(JointState, "/looped", 100)
    command = start(
        f"arm bag play {bag} --loop --rate 20 --start-offset 1 --topics /joint_states "
        "-m /joint_states:=/looped"
    )
    with BagReader(bag) as reader:
        start_ns = reader.metadata.span.start_ns + 10**9
        once = len(list(reader.messages(["/joint_states"], start_ns)))
    played.wait_for(3 * once)
    assert command.interrupt() == 0
    assert "Playing stopped\n" in command.err


def test_a_killed_recorder_leaves_a_bag(start, run, counts, tmp_path):
    folder = tmp_path / "killed"
    command = start(f"arm bag record -a -o {folder}")
    both = {"/robot_description", "/joint_states"}
    command.wait_until(lambda: both <= set(+counts(folder)), "robot and states are in the bag")
    command.kill()
    kept = counts(folder)
    assert both <= set(+kept)
    info = start(f"arm bag info {folder}")
    assert info.wait() == 0
    assert "killed_0.mcap was not finished" in info.err
    assert f"Messages:          {kept.total()}\n" in info.out
    run(f"arm bag play {folder} --rate 100 --topics /joint_states -m /joint_states:=/x")


def test_record_waits_for_a_missing_topic(start, client, counts, tmp_path):
    folder = tmp_path / "late"
    command = start(f"arm bag record /joint_stats /late -o {folder}")
    command.wait_for("waiting for a publisher of /joint_stats on ROS_DOMAIN_ID=")
    command.wait_for("did you mean '/joint_states'")
    publisher = client.node.create_publisher(TFMessage, "/late", LATCHED)
    command.wait_for("Subscribed to topic '/late'")
    publisher.publish(TFMessage())
    command.wait_until(lambda: counts(folder)["/late"] == 1, "the message is in the bag")
    command.process.send_signal(signal.SIGTERM)
    assert command.wait() == 0, command.err


def test_a_similar_topic_that_appears_late_is_suggested(start, client, tmp_path):
    command = start(f"arm bag record /chattr -o {tmp_path / 'late'}")
    command.wait_for("waiting for a publisher of /chattr on ROS_DOMAIN_ID=")
    client.node.create_publisher(TFMessage, "/chatter", 10)
    command.wait_for("did you mean '/chatter'")
    command.process.send_signal(signal.SIGTERM)
    assert command.wait() == 0, command.err


def test_invalid_topic_names_are_refused_and_leave_no_bag(run, tmp_path):
    folder = tmp_path / "none"
    for line in (f"'/a b' -o {folder}", f"/tf --topics 7th -o {folder}"):
        text = run(f"arm bag record {line}", code=2)
        assert "': Invalid topic name: topic name" in text
        assert text.count("\n") == 1
        assert not folder.exists()


def test_an_existing_bag_is_not_overwritten(run, bag):
    text = run(f"arm bag record -a -o {bag}", code=1)
    assert text == f"arm bag record: Output folder '{bag}' already exists.\n"
