"""`arm dataset convert`: bags become a dataset, and what that costs is said."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float64MultiArray

from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex
from arm_cli.main import main

MS = 1_000_000
WALL = 1_700_000_000_000 * MS
"""Time of reception of the message with stamp 0."""
TYPES = {
    JointState: "sensor_msgs/msg/JointState",
    Image: "sensor_msgs/msg/Image",
    Float64MultiArray: "std_msgs/msg/Float64MultiArray",
}
Recorded = tuple[str, int, Any]
"""A topic, the time in ms at which a message is received, and the message."""


def stamped(message: Any, stamp_ms: int) -> Any:
    message.header.stamp.sec, rest = divmod(stamp_ms, 1000)
    message.header.stamp.nanosec = rest * MS
    return message


def states(times: Sequence[int]) -> list[Recorded]:
    return [
        (
            "/joint_states",
            time,
            stamped(JointState(name=["b", "a"], position=[0.001 * time, 1.0]), time),
        )
        for time in times
    ]


def images(times: Sequence[int], encoding: str = "rgb8") -> list[Recorded]:
    def image(value: int) -> Image:
        data = np.full((4, 8, 3), value, dtype=np.uint8).tobytes()
        return Image(height=4, width=8, step=24, encoding=encoding, data=data)

    return [("/camera/image_raw", time, stamped(image(time), time)) for time in times]


def commands(times: Sequence[int], topic: str = "/position_controller/commands") -> list[Recorded]:
    return [(topic, time, Float64MultiArray(data=[0.5, float(time)])) for time in times]


def write(folder: Path, messages: list[Recorded]) -> Path:
    bag = BagWriter(folder, BagSettings())
    for topic, kind in {topic: TYPES[type(message)] for topic, _, message in messages}.items():
        bag.add_topic(BagTopic(topic, kind), find_definition(InterfaceIndex(), kind))
    for topic, time_ms, message in sorted(messages, key=lambda one: one[1]):
        time_ns = WALL + time_ms * MS
        bag.write(BagMessage(topic, time_ns, time_ns, bytes(serialize_message(message))))
    bag.close()
    return folder


Convert = Callable[..., str]


@pytest.fixture
def convert(tmp_path, capsys) -> Convert:
    """Return a function that converts bags and returns what is printed."""

    def run(*bags: Path, options: Sequence[str] = (), code: int = 0) -> str:
        words = ["dataset", "convert", *map(str, bags), "-o", str(tmp_path / "out")]
        assert main([*words, "--task", "wave", *options]) == code
        said = capsys.readouterr()
        return said.err if code else said.out

    return run


def test_bags_become_the_episodes_of_a_dataset(tmp_path, convert):
    messages = states(range(0, 300, 10)) + images(range(0, 300, 50)) + commands([42, 141])
    bags = [write(tmp_path / name, messages) for name in ("one", "two")]
    said = convert(*bags)
    assert "5 rows at 20 Hz, off by up to 0.0 ms" in said
    assert "observation.images.camera: 5 messages, one in each row" in said
    assert "observation.state: 21 messages, 16 in no row; 0 rows repeat a message" in said
    assert "action: 2 messages, 0 in no row; 3 rows repeat a message" in said
    assert "gets the stamp of the last state before it" in said
    rows = pq.read_table(tmp_path / "out/data/chunk-000/file-000.parquet").slice(5)
    assert rows["stamp_ns.camera"].to_pylist() == [time * MS for time in (50, 100, 150, 200, 250)]
    assert rows["stamp_ns.action"].to_pylist() == [time * MS for time in (40, 40, 140, 140, 140)]
    assert rows["observation.state"].to_pylist()[1] == pytest.approx([0.1, 1.0])
    assert rows["action"].to_pylist()[2] == [0.5, 141.0]
    info = json.loads((tmp_path / "out/meta/info.json").read_text())
    assert info["total_episodes"] == 2
    assert info["features"]["observation.state"]["names"] == ["b.pos", "a.pos"]
    assert info["features"]["action"]["names"] == ["b.cmd", "a.cmd"]
    assert main(["dataset", "check", str(tmp_path / "out")]) == 0


def test_without_cameras_the_rows_are_the_states(tmp_path, convert):
    bag = write(tmp_path / "bag", states(range(0, 100, 10)) + commands([0]))
    said = convert(bag, options=["--state-fields", "position"])
    assert "10 rows at 100 Hz" in said
    assert "observation.state: 10 messages, one in each row" in said


def test_a_message_sent_twice_counts_once_and_is_told(tmp_path, convert):
    bag = write(tmp_path / "bag", states([0, 10, 10, 20]) + commands([0]))
    said = convert(bag)
    assert "1 messages of /joint_states are left out: others have the same or a later stamp" in said


@pytest.mark.parametrize(
    ("messages", "options", "sentence"),
    [
        (commands([0]), [], "no messages of /joint_states; --state can be nothing"),
        (states([0, 10]), [], "no topic with messages is a command"),
        (
            states([0, 10]) + commands([0]) + commands([0], "/other/commands"),
            [],
            "choose one with --action: /position_controller/commands, /other/commands",
        ),
        (
            states([0, 10]) + commands([0]) + images([0, 50], "32FC1"),
            [],
            "images of /camera/image_raw are 32FC1; those of a dataset are rgb8",
        ),
        (
            states([0, 10]) + commands([0]),
            ["--state-fields", "effort"],
            "messages of /joint_states do not have the effort of every joint",
        ),
        (states([0]) + commands([0]), [], "has only one message, so it has no rate"),
    ],
)
def test_a_bag_that_is_no_demonstration_is_refused(tmp_path, convert, messages, options, sentence):
    assert sentence in convert(write(tmp_path / "bag", messages), options=options, code=1)
    assert not (tmp_path / "out").exists()
