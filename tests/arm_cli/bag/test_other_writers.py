"""Bags of other writers, with each of their options: every verb reads what was written."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import combinations, product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
import yaml
from mcap.reader import NonSeekingReader
from mcap.writer import CompressionType, IndexType, Writer
from rosbags.highlevel import AnyReader
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability
from rosbags.interfaces import QosTime as Time
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from arm_cli.main import main

STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = STORE.types
MS = 1_000_000
START_NS = 1_700_000_000_000 * MS
STATES, COMMANDS, NOTES = "/joint_states", "/position_controller/commands", "/notes"
TOPICS = {
    STATES: "sensor_msgs/msg/JointState",
    COMMANDS: "std_msgs/msg/Float64MultiArray",
    NOTES: "std_msgs/msg/String",
}
OLD_QOS = """- history: 3
  depth: 0
  reliability: 1
  durability: 2
  deadline: {sec: 2147483647, nsec: 4294967295}
  lifespan: {sec: 0, nsec: 0}
  liveliness: 1
  liveliness_lease_duration: {sec: 9223372036, nsec: 854775807}
  avoid_ros_namespace_conventions: false
"""
"""As recorders before Jazzy wrote it, with the three numbers that mean "no limit"."""

Recorded = tuple[str, int, bytes]


def serialized(kind: str, *fields: Any) -> bytes:
    return bytes(STORE.serialize_cdr(TYPES[kind](*fields), kind))


def state(time_ms: int) -> bytes:
    header = TYPES["std_msgs/msg/Header"](
        TYPES["builtin_interfaces/msg/Time"](0, time_ms * MS), "base"
    )
    positions = np.array([0.001 * time_ms, 1.0])
    return serialized(TOPICS[STATES], header, ["a", "b"], positions, np.array([]), np.array([]))


def command(value: float) -> bytes:
    layout = TYPES["std_msgs/msg/MultiArrayLayout"]([], 0)
    return serialized(TOPICS[COMMANDS], layout, np.array([value, 0.5]))


def recording() -> list[Recorded]:
    """Nine messages; the note is written after later ones."""
    at = [(STATES, time_ms, state(time_ms)) for time_ms in (0, 10, 20, 30, 40, 50)]
    at += [(COMMANDS, 12, command(1.25)), (COMMANDS, 33, command(2.5))]
    at = sorted(at, key=lambda one: one[1])
    at.insert(7, (NOTES, 11, serialized(TOPICS[NOTES], "grasped")))
    return [(topic, START_NS + time_ms * MS, data) for topic, time_ms, data in at]


EXPECTED = sorted(recording(), key=lambda one: one[1])


@dataclass(frozen=True)
class McapOptions:
    """The options of mcap's writer."""

    compression: CompressionType | None
    indexes: IndexType
    repeats: bool
    statistics: bool
    finished: bool = True

    def __str__(self) -> str:
        words = [
            self.compression.name.lower() if self.compression else "unchunked",
            {IndexType.ALL: "indexed", IndexType.CHUNK: "chunk-index"}.get(
                self.indexes, "no-index"
            ),
            *([] if self.repeats else ["no-repeats"]),
            *([] if self.statistics else ["no-statistics"]),
            *([] if self.finished else ["unfinished"]),
        ]
        return "-".join(words)

    def write(self, folder: Path) -> Path:
        folder.mkdir()
        with (folder / "bag_0.mcap").open("wb") as stream:
            writer = Writer(
                stream,
                chunk_size=200,
                compression=self.compression or CompressionType.NONE,
                index_types=self.indexes,
                repeat_channels=self.repeats,
                repeat_schemas=self.repeats,
                use_chunking=self.compression is not None,
                use_statistics=self.statistics,
                use_summary_offsets=self.repeats,
            )
            writer.start("ros2", "somebody")
            channels = {topic: add_channel(writer, topic, kind) for topic, kind in TOPICS.items()}
            for topic, time_ns, data in recording():
                writer.add_message(channels[topic], time_ns, data, time_ns)
            if self.finished:
                writer.finish()
            else:
                writer.flush()
        return folder


def add_channel(writer: Writer, topic: str, kind: str, definition: str | None = None) -> int:
    text = STORE.generate_msgdef(kind, ros_version=2)[0] if definition is None else definition
    schema = writer.register_schema(kind, "ros2msg", text.encode())
    return writer.register_channel(topic, "cdr", schema, {"offered_qos_profiles": OLD_QOS})


@dataclass(frozen=True)
class RosbagsOptions:
    """The options of rosbags' writer."""

    version: int
    mode: CompressionMode

    def __str__(self) -> str:
        return f"rosbags-{self.version}-{self.mode.name.lower()}"

    def write(self, folder: Path) -> Path:
        offers = [
            Qos(
                QosHistory.UNKNOWN,
                0,
                QosReliability.RELIABLE,
                QosDurability.VOLATILE,
                Time(2147483647, 4294967295),
                Time(0, 0),
                QosLiveliness.AUTOMATIC,
                Time(9223372036, 854775807),
                False,
            )
        ]
        writer = RosbagsWriter(folder, version=self.version, storage_plugin=StoragePlugin.MCAP)
        writer.set_compression(self.mode, CompressionFormat.ZSTD)
        writer.set_custom_data("operator", "Ada")
        with writer:
            connections = {
                topic: writer.add_connection(
                    topic, kind, typestore=STORE, offered_qos_profiles=offers
                )
                for topic, kind in TOPICS.items()
            }
            for topic, time_ns, data in recording():
                writer.write(connections[topic], time_ns, data)
        return folder


COMPRESSIONS = (None, CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD)
INDEXES = (IndexType.ALL, IndexType.CHUNK, IndexType.NONE)
EVERY_MCAP = [
    McapOptions(*options)
    for options in product(COMPRESSIONS, INDEXES, (True, False), (True, False))
]
"""All combinations; `arm bag info` opens each."""
MCAP = [
    McapOptions(compression, indexes, (row + column) % 2 == 0, (row + column) % 4 < 2)
    for row, compression in enumerate(COMPRESSIONS)
    for column, indexes in enumerate(INDEXES)
] + [
    McapOptions(compression, IndexType.ALL, True, True, finished=False)
    for compression in (None, CompressionType.ZSTD)
]
"""Each pair of two options' values is in one of them."""
READABLE_MODES = (CompressionMode.NONE, CompressionMode.STORAGE, CompressionMode.MESSAGE)
ROSBAGS = [RosbagsOptions(version, mode) for version, mode in product((8, 9), READABLE_MODES)]
Options = McapOptions | RosbagsOptions


def in_all_bags(test: Callable[..., None]) -> Callable[..., None]:
    return pytest.mark.parametrize("options", [*MCAP, *ROSBAGS], ids=str)(test)


def test_the_bags_have_each_pair_of_options():
    def pairs(bags: list[McapOptions]) -> set[tuple[Any, ...]]:
        of = ("compression", "indexes", "repeats", "statistics")
        return {
            (a, getattr(bag, a), b, getattr(bag, b)) for bag in bags for a, b in combinations(of, 2)
        }

    assert pairs(EVERY_MCAP) <= pairs(MCAP)


def read_by_rosbags(folder: Path) -> list[Recorded]:
    with AnyReader([folder]) as reader:
        return [(c.topic, time_ns, bytes(data)) for c, time_ns, data in reader.messages()]


def read_by_mcap(folder: Path) -> list[Recorded]:
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as stream:
        found = NonSeekingReader(stream).iter_messages()
        return [(channel.topic, message.log_time, message.data) for _, channel, message in found]


def said(capsys: pytest.CaptureFixture[str], *words: object, code: int = 0) -> tuple[str, str]:
    assert main([str(word) for word in words]) == code
    captured = capsys.readouterr()
    return captured.out, captured.err


def unfinished(options: Options) -> bool:
    return isinstance(options, McapOptions) and not options.finished


@pytest.mark.parametrize("options", EVERY_MCAP, ids=str)
def test_the_bags_are_what_an_independent_reader_reads(tmp_path, options):
    assert read_by_mcap(options.write(tmp_path / "bag")) == EXPECTED


@pytest.mark.parametrize("options", [*EVERY_MCAP, *MCAP[-2:], *ROSBAGS], ids=str)
def test_info(tmp_path, capsys, options):
    bag = options.write(tmp_path / "bag")
    out, err = said(capsys, "bag", "info", "--json", bag)
    info = json.loads(out)
    assert {one["name"]: (one["type"], one["count"]) for one in info["topics"]} == {
        STATES: (TOPICS[STATES], 6),
        COMMANDS: (TOPICS[COMMANDS], 2),
        NOTES: (TOPICS[NOTES], 1),
    }
    assert (info["message_count"], info["duration_s"]) == (9, 0.05)
    assert (info["start_ns"], info["end_ns"]) == (EXPECTED[0][1], EXPECTED[-1][1])
    assert ("was not finished" in err) == unfinished(options)
    by_message = isinstance(options, RosbagsOptions) and options.mode == CompressionMode.MESSAGE
    assert (info["compression_mode"].lower() == "message") == by_message
    shown, _ = said(capsys, "bag", "info", bag)
    assert ("Compression:       zstd by message\n" in shown) == by_message


@contextmanager
def stand_in(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Recorded]]:
    """Replace ROS below `arm bag play`; yield what would be published."""
    published: list[Recorded] = []

    class Player:
        def __init__(self, *_: object) -> None: ...

        def advertise(self, topics: list[Any], *_: object) -> list[str]:
            return [one.topic.name for one in topics]

        def play(self, messages: Any, *_: object, **__: object) -> None:
            published.extend((one.topic, one.log_time_ns, one.data) for one in messages)

        def finish(self) -> None: ...

    @contextmanager
    def connect(*_: object) -> Iterator[Any]:
        yield SimpleNamespace(spin_for=lambda _: None)

    monkeypatch.setattr("arm_cli.bag.play.connect", connect)
    monkeypatch.setattr("arm_cli.bag.ros_player.BagPlayer", Player)
    yield published


@in_all_bags
def test_play(tmp_path, monkeypatch, options):
    bag = options.write(tmp_path / "bag")
    with stand_in(monkeypatch) as published:
        assert main(["bag", "play", str(bag)]) == 0
    assert published == EXPECTED
    published.clear()
    with stand_in(monkeypatch) as published:
        (file,) = bag.glob("*.mcap")
        assert main(["bag", "play", str(file), "--start-offset", "0.03", "--topics", STATES]) == 0
    assert published == [one for one in EXPECTED[-4:] if one[0] == STATES]


@in_all_bags
def test_convert(tmp_path, capsys, options):
    bag, out = options.write(tmp_path / "bag"), tmp_path / "out"
    (tmp_path / "options.yaml").write_text(f"output_bags: [{{uri: {out}, all_topics: true}}]")
    text, _ = said(capsys, "bag", "convert", "-i", bag, "-o", tmp_path / "options.yaml")
    assert text == f"wrote {out}: 9 messages\n"
    assert read_by_rosbags(out) == read_by_mcap(out) == EXPECTED
    with AnyReader([out]) as reader:
        assert {c.ext.offered_qos_profiles[0].deadline for c in reader.connections} == {
            Time(2147483647, 4294967295)
        }


@pytest.mark.parametrize(
    ("options", "lost"),
    [*((one, False) for one in (*MCAP, *ROSBAGS)), *((one, True) for one in ROSBAGS)],
    ids=str,
)
def test_reindex(tmp_path, capsys, options, lost):
    bag = options.write(tmp_path / "bag")
    metadata = bag / "metadata.yaml"
    before = yaml.safe_load(metadata.read_text()) if metadata.exists() else None
    if lost:
        metadata.unlink()
    text, _ = said(capsys, "bag", "reindex", bag)
    assert text == f"wrote {metadata}: 9 messages\n"
    information = yaml.safe_load(metadata.read_text())["rosbag2_bagfile_information"]
    assert (information["message_count"], information["duration"]["nanoseconds"]) == (9, 50 * MS)
    counts = {
        one["topic_metadata"]["name"]: one["message_count"]
        for one in information["topics_with_message_count"]
    }
    assert counts == {STATES: 6, COMMANDS: 2, NOTES: 1}
    durations = information["topics_with_message_count"][0]["topic_metadata"][
        "offered_qos_profiles"
    ][0]
    assert durations["deadline"] == {"sec": 2147483647, "nsec": 4294967295}
    assert durations["lifespan"] == {"sec": 0, "nsec": 0}
    assert durations["liveliness_lease_duration"] == {"sec": 9223372036, "nsec": 854775807}
    if before is not None:
        old = before["rosbag2_bagfile_information"]
        mode = information["compression_mode"]
        assert mode.lower() == old["compression_mode"]
        assert (mode == "message") == (bool(mode) and not lost)
        for kept in ("compression_format", "custom_data", "ros_distro", "relative_file_paths"):
            assert information[kept] == old[kept], kept
    # rosbags needs the index of messages, channels that it finds, and the order of time where there
    # are no chunks.
    if isinstance(options, RosbagsOptions) or (
        options.indexes == IndexType.ALL
        and options.compression
        and options.finished
        and (options.repeats or options.statistics)
    ):
        assert read_by_rosbags(bag) == EXPECTED


@in_all_bags
def test_dataset(tmp_path, capsys, options):
    bag, out = options.write(tmp_path / "bag"), tmp_path / "out"
    said(capsys, "dataset", "convert", bag, "-o", out, "--task", "wave", "--fps", 100)
    rows = pq.read_table(out / "data/chunk-000/file-000.parquet")
    assert rows["observation.state"].to_pylist() == pytest.approx(
        np.array([[0.001 * time_ms, 1.0] for time_ms in (10, 20, 30, 40, 50)], dtype=np.float32)
    )
    assert [row[0] for row in rows["action"].to_pylist()] == [1.25, 1.25, 2.5, 2.5, 2.5]


@pytest.mark.parametrize("verb", ["info", "play", "reindex", "convert", "dataset"])
@pytest.mark.parametrize("kind", ["file", "message by lz4"])
def test_a_compression_that_is_not_read_is_refused(tmp_path, capsys, verb, kind):
    bag = tmp_path / "bag"
    mode = CompressionMode.FILE if kind == "file" else CompressionMode.MESSAGE
    RosbagsOptions(9, mode).write(bag)
    metadata = bag / "metadata.yaml"
    if kind != "file":
        metadata.write_text(metadata.read_text().replace("format: zstd", "format: lz4"))
    before = metadata.read_text()
    (tmp_path / "options.yaml").write_text(
        f"output_bags: [{{uri: {tmp_path / 'out'}, all_topics: true}}]"
    )
    words = {
        "convert": ["bag", "convert", "-i", bag, "-o", tmp_path / "options.yaml"],
        "dataset": ["dataset", "convert", bag, "-o", tmp_path / "out", "--task", "wave"],
    }
    _, err = said(capsys, *words.get(verb, ["bag", verb, bag]), code=1)
    wanted = "is compressed as a whole" if kind == "file" else "are compressed as 'lz4'"
    assert wanted in err
    assert err.count("\n") == 1
    assert metadata.read_text() == before
