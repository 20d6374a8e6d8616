"""Other readers read written bags, and torn bags are readable."""

import random
import shutil
from collections import Counter
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.reader import BagReader, warn_if_unfinished
from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition, find_definition
from arm_cli.bag_format.writer import CHUNK_BYTES, BagSettings, BagWriter
from arm_cli.errors import BagError
from arm_cli.interface_types import InterfaceIndex

STORE = get_typestore(Stores.ROS2_JAZZY)
POINT = "geometry_msgs/msg/PointStamped"
MS = 1_000_000
START_NS = 1_700_000_000 * 1000 * MS

POINTS = BagTopic("/points", POINT, STORE.hash_rihs01(POINT), (OfferedQos(),))
LATCHED = BagTopic(
    "/latched",
    "std_msgs/msg/String",
    STORE.hash_rihs01("std_msgs/msg/String"),
    (OfferedQos(durability="transient_local"), OfferedQos(reliability="best_effort")),
)


def point(x: float) -> bytes:
    types = STORE.types
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](1, 2), "world")
    message = types[POINT](header, types["geometry_msgs/msg/Point"](x, 0.0, 0.0))
    return bytes(STORE.serialize_cdr(message, POINT))


def text(data: str) -> bytes:
    name = "std_msgs/msg/String"
    return bytes(STORE.serialize_cdr(STORE.types[name](data), name))


def writer(folder: Path, **settings) -> BagWriter:
    made = BagWriter(folder, BagSettings(**settings))
    index = InterfaceIndex()
    for topic in (POINTS, LATCHED):
        made.add_topic(topic, find_definition(index, topic.type))
    return made


def message(number: int, data: bytes | None = None) -> BagMessage:
    time_ns = START_NS + number * MS
    return BagMessage("/points", time_ns, time_ns - 5, point(number) if data is None else data)


def write(folder: Path, count: int = 10, **settings) -> Path:
    bag = writer(folder, **settings)
    bag.write(BagMessage("/latched", START_NS, START_NS, text("hello")))
    for number in range(count):
        bag.write(message(number))
    bag.close()
    return folder


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_rosbags_reads_a_written_bag(tmp_path, compression):
    bag = write(tmp_path / "bag", compression=compression)
    with AnyReader([bag]) as reader:
        read = [
            (connection.topic, time_ns, reader.deserialize(data, connection.msgtype))
            for connection, time_ns, data in reader.messages()
        ]
    assert len(read) == 11
    assert [m.point.x for topic, _, m in read if topic == "/points"] == list(range(10))
    assert next(m.data for topic, _, m in read if topic == "/latched") == "hello"
    assert read[-1][1] == START_NS + 9 * MS


def test_rosbags_finds_type_hashes_and_qos_in_the_metadata(tmp_path):
    with Reader(write(tmp_path / "bag")) as reader:
        connections = {connection.topic: connection for connection in reader.connections}
        # rosbags finds no message where QoS or types differ between metadata.yaml and the file.
        assert len(list(reader.messages([connections["/latched"]]))) == 1
    assert connections["/points"].digest == POINTS.type_hash
    offers = connections["/latched"].ext.offered_qos_profiles
    assert [offer.durability.name for offer in offers] == ["TRANSIENT_LOCAL", "VOLATILE"]
    assert [offer.reliability.name for offer in offers] == ["RELIABLE", "BEST_EFFORT"]
    assert offers[0].deadline.sec == 9223372036


def test_mcap_decodes_a_bag_with_its_own_schemas(tmp_path):
    bag = write(tmp_path / "bag", compression="zstd")
    with (bag / "bag_0.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        read = list(reader.iter_decoded_messages(topics=["/points"]))
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
        assert reader.get_header().profile == "ros2"
    assert read[3].decoded_message.point.x == 3.0
    assert read[3].decoded_message.header.frame_id == "world"
    assert read[3].message.publish_time == START_NS + 3 * MS - 5
    assert read[3].channel.metadata["topic_type_hash"] == POINTS.type_hash
    assert "name: /points" in metadata["rosbag2"]["serialized_metadata"]


def test_a_written_bag_is_read_back(tmp_path):
    reader = BagReader(write(tmp_path / "bag"))
    assert dict(reader.metadata.topics) == {POINTS: 10, LATCHED: 1}
    assert reader.metadata.span.duration_ns == 9 * MS
    assert reader.metadata.ros_distro == "jazzy"
    assert reader.unfinished == []
    assert list(reader.messages(["/points"], START_NS + 8 * MS)) == [message(8), message(9)]
    reader.close()


def test_messages_come_in_the_order_of_their_times(tmp_path):
    bag = writer(tmp_path / "bag")
    for number in (3, 1, 2):
        bag.write(message(number))
    bag.close()
    reader = BagReader(tmp_path / "bag")
    assert list(reader.messages(["/points"])) == [message(1), message(2), message(3)]
    reader.close()


def test_a_single_file_is_a_bag_too(tmp_path):
    reader = BagReader(write(tmp_path / "bag") / "bag_0.mcap")
    assert reader.metadata.message_count == 11
    assert reader.metadata.ros_distro == "jazzy"
    reader.close()


def test_files_are_split_by_size(tmp_path):
    bag = writer(tmp_path / "bag", max_size_bytes=5000)
    for number in range(12):
        bag.write(message(number, bytes(1000)))
    bag.close()
    names = sorted(path.name for path in (tmp_path / "bag").glob("*.mcap"))
    assert names == [f"bag_{number}.mcap" for number in range(len(names))]
    assert 2 <= len(names) <= 6
    reader = BagReader(tmp_path / "bag")
    assert [m.log_time_ns for m in reader.messages(["/points"])] == [
        START_NS + number * MS for number in range(12)
    ]
    reader.close()


def test_files_are_split_by_duration(tmp_path):
    bag = write(tmp_path / "bag", max_duration_ns=4 * MS)
    reader = BagReader(bag)
    assert [file.message_count for file in reader.metadata.files] == [5, 4, 2]
    reader.close()
    with AnyReader([bag]) as other:
        assert other.message_count == len(list(other.messages())) == 11


def test_an_unfinished_bag_is_readable_up_to_the_last_flush(tmp_path, capsys):
    bag = writer(tmp_path / "bag")
    for number in range(5):
        bag.write(message(number))
    bag.flush()
    bag.write(message(5))
    reader = BagReader(tmp_path / "bag")
    assert list(reader.messages(["/points"])) == [message(number) for number in range(5)]
    assert dict(reader.metadata.topics) == {POINTS: 5, LATCHED: 0}
    warn_if_unfinished(reader, "arm bag info")
    assert capsys.readouterr().err.startswith("arm bag info: bag_0.mcap was not finished")
    reader.close()
    # Readers that do not handle killed recorders read the same.
    with AnyReader([tmp_path / "bag"]) as other:
        assert len(list(other.messages())) == 5
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as stream:
        assert len(list(make_reader(stream, validate_crcs=True).iter_messages())) == 5
    bag.close()


def test_large_messages_are_flushed_at_once(tmp_path):
    bag = writer(tmp_path / "bag")
    bag.write(message(0, bytes(CHUNK_BYTES)))
    reader = BagReader(tmp_path / "bag")
    assert reader.metadata.message_count == 1
    reader.close()
    bag.close()


@pytest.mark.parametrize("torn_bytes", [1, 9, 40, 300])
def test_a_torn_end_loses_at_most_the_last_chunk(tmp_path, torn_bytes):
    bag = writer(tmp_path / "bag")
    for number in range(4):
        bag.write(message(number))
        bag.flush()
    path = tmp_path / "bag" / "bag_0.mcap"
    size = path.stat().st_size
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(path.read_bytes()[: size - torn_bytes])
    reader = BagReader(torn)
    count = reader.metadata.message_count
    assert 2 <= count <= 4
    assert list(reader.messages(["/points"])) == [message(number) for number in range(count)]
    reader.close()
    bag.close()


def test_a_file_torn_at_any_length_is_readable(tmp_path):
    whole = (write(tmp_path / "bag", count=3) / "bag_0.mcap").read_bytes()
    torn = tmp_path / "torn.mcap"
    counts = Counter()
    for length in range(8, len(whole), 7):
        torn.write_bytes(whole[:length])
        reader = BagReader(torn)
        counts[reader.metadata.message_count] += 1
        assert len(list(reader.messages(["/points", "/latched"]))) == reader.metadata.message_count
        reader.close()
    assert counts.keys() == {0, 4}


def test_an_empty_bag_is_valid(tmp_path):
    bag = BagWriter(tmp_path / "bag", BagSettings())
    bag.close()
    reader = BagReader(tmp_path / "bag")
    assert reader.metadata.message_count == 0
    assert list(reader.messages([])) == []
    reader.close()


def test_a_type_without_a_definition_is_recorded(tmp_path):
    bag = BagWriter(tmp_path / "bag", BagSettings())
    bag.add_topic(BagTopic("/odd", "odd_msgs/msg/Odd"), TypeDefinition("odd_msgs/msg/Odd", b""))
    bag.write(BagMessage("/odd", START_NS, START_NS, b"\x00\x01\x00\x00"))
    bag.close()
    reader = BagReader(tmp_path / "bag")
    assert [topic.type for topic in reader.topics] == ["odd_msgs/msg/Odd"]
    reader.close()


def test_an_existing_folder_is_not_touched(tmp_path):
    with pytest.raises(BagError, match="already exists"):
        BagWriter(tmp_path, BagSettings())
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_created_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BagError, match=r"Could not create bag folder .*: Not a directory"):
        BagWriter(tmp_path / "file" / "bag", BagSettings())


def test_damage_in_a_finished_file_is_reported(tmp_path):
    path = write(tmp_path / "bag", count=50) / "bag_0.mcap"
    content = bytearray(path.read_bytes())
    content[content.index(point(20.0)) + 30] ^= 0xFF
    path.write_bytes(content)
    reader = BagReader(path)
    with pytest.raises(BagError, match=r"bag_0\.mcap is damaged: crc validation failed"):
        list(reader.messages(["/points"]))
    reader.close()


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_random_damage_is_reported_or_harmless(tmp_path, compression):
    whole = (write(tmp_path / "bag", compression=compression) / "bag_0.mcap").read_bytes()
    chance = random.Random(1)
    damaged = tmp_path / "damaged.mcap"
    refusals = []
    for _ in range(150):
        content = bytearray(whole)
        content[chance.randrange(8, len(content))] = chance.randrange(256)
        damaged.write_bytes(content)
        try:
            with BagReader(damaged) as reader:
                assert len(list(reader.messages([topic.name for topic in reader.topics]))) <= 11
        except BagError as error:
            refusals.append(str(error))
    assert len(refusals) > 10
    assert all("damaged.mcap is damaged: " in refusal for refusal in refusals)
    assert not any("\n" in refusal for refusal in refusals)


@pytest.mark.parametrize(
    ("content", "sentence"), [(b"", "is not an MCAP file"), (b"a" * 500, "is not an MCAP file")]
)
def test_a_file_that_is_not_mcap_is_reported(tmp_path, content, sentence):
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    with pytest.raises(BagError, match=sentence):
        BagReader(path)


@pytest.mark.parametrize(
    ("metadata", "sentence"),
    [
        ("nothing: here", r"metadata\.yaml does not hold a bag's metadata \(KeyError"),
        ("[", r"metadata\.yaml does not hold a bag's metadata"),
        ("", r"metadata\.yaml does not hold a bag's metadata"),
    ],
)
def test_invalid_metadata_are_reported(tmp_path, metadata, sentence):
    bag = write(tmp_path / "bag")
    (bag / "metadata.yaml").write_text(metadata)
    with pytest.raises(BagError, match=sentence):
        BagReader(bag)


def test_a_folder_without_metadata_is_read_by_its_files(tmp_path):
    bag = write(tmp_path / "bag")
    (bag / "metadata.yaml").unlink()
    reader = BagReader(bag)
    assert reader.metadata.message_count == 11
    reader.close()


def test_a_folder_without_a_bag_is_reported(tmp_path):
    with pytest.raises(BagError, match="neither metadata"):
        BagReader(tmp_path)


def test_a_missing_file_is_reported_by_name(tmp_path):
    bag = write(tmp_path / "bag")
    (bag / "bag_0.mcap").unlink()
    with pytest.raises(BagError, match=r"cannot read .*bag_0\.mcap: No such file"):
        BagReader(bag)


def test_other_storage_formats_are_reported(tmp_path):
    (tmp_path / "old_0.db3").write_bytes(b"SQLite format 3\0")
    with pytest.raises(BagError, match="stored as sqlite3, but only mcap can be read"):
        BagReader(tmp_path)


def test_a_bag_that_rosbags_wrote_is_read(tmp_path):
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as other:
        connection = other.add_connection("/points", POINT, typestore=STORE)
        other.write(connection, START_NS, point(7.0))
    reader = BagReader(tmp_path / "bag")
    assert list(reader.messages(["/points"])) == [
        BagMessage("/points", START_NS, START_NS, point(7.0))
    ]
    reader.close()
    shutil.rmtree(tmp_path / "bag")
