"""Bags are rewritten: `arm bag convert` and `arm bag reindex`."""

from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from arm_cli.bag_format.metadata import FILE_NAME
from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.interface_types import InterfaceIndex
from arm_cli.main import main

STORE = get_typestore(Stores.ROS2_JAZZY)
STRING = "std_msgs/msg/String"


def write(folder: Path, *messages: tuple[str, int, str]) -> Path:
    """Write a bag of strings: topic, time in ns, text."""
    bag = BagWriter(folder, BagSettings())
    for topic in dict.fromkeys(topic for topic, _, _ in messages):
        hash_ = STORE.hash_rihs01(STRING)
        bag.add_topic(BagTopic(topic, STRING, hash_), find_definition(InterfaceIndex(), STRING))
    for topic, time_ns, text in messages:
        data = bytes(STORE.serialize_cdr(STORE.types[STRING](text), STRING))
        bag.write(BagMessage(topic, time_ns, time_ns, data))
    bag.close()
    return folder


def read(folder: Path) -> list[tuple[str, int, str]]:
    """Read a bag with rosbags."""
    with AnyReader([folder]) as reader:
        return [
            (connection.topic, time_ns, reader.deserialize(data, connection.msgtype).data)
            for connection, time_ns, data in reader.messages()
        ]


@pytest.fixture
def convert(tmp_path, capsys):
    """Return a function that converts bags by options in YAML; it returns what is printed."""

    def run(options: str, *bags: Path, code: int = 0) -> str:
        file = tmp_path / "options.yaml"
        file.write_text(options)
        words = [word for bag in bags for word in ("-i", str(bag), "mcap")]
        assert main(["bag", "convert", *words, "-o", str(file)]) == code
        said = capsys.readouterr()
        return said.err if code else said.out

    return run


def test_bags_are_merged_in_the_order_of_time(tmp_path, convert):
    first = write(tmp_path / "a", ("/x", 10, "one"), ("/x", 30, "three"))
    second = write(tmp_path / "b", ("/y", 20, "two"))
    out = tmp_path / "out"
    text = convert(
        f"output_bags: [{{uri: {out}, storage_id: mcap, all_topics: true, "
        "compression_format: zstd}]",
        first,
        second,
    )
    assert text == f"wrote {out}: 3 messages\n"
    assert read(out) == [("/x", 10, "one"), ("/y", 20, "two"), ("/x", 30, "three")]


def test_one_bag_is_split_by_topics(tmp_path, convert):
    bag = write(tmp_path / "a", ("/x", 10, "one"), ("/y", 20, "two"), ("/z/y", 30, "three"))
    x, y = tmp_path / "only_x", tmp_path / "only_y"
    convert(
        f"output_bags:\n- uri: {x}\n  topics: [x]\n- uri: {y}\n  regex: y\n  exclude_topics: [/y]",
        bag,
    )
    assert read(x) == [("/x", 10, "one")]
    assert read(y) == [("/z/y", 30, "three")]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ("nothing", "has no list 'output_bags'"),
        ("output_bags: [{all: true}]", "bag 1: 'uri', the folder to write, is missing"),
        ("output_bags: [{uri: o, topcs: [/x]}]", "no option 'topcs'; did you mean 'topics'"),
        ("output_bags: [{uri: o, topics: /x}]", "topics '/x' is not a list of topics"),
        ("output_bags: [{uri: o, storage_id: sqlite3}]", "only mcap can be written"),
        ("output_bags: [{uri: o, compression_format: gzip}]", "it is none, lz4 or zstd"),
        ("output_bags: [{uri: o, max_bagfile_size: big}]", "'big' is not a whole number"),
        ("output_bags: [{uri: o, regex: '('}]", "is not a regular expression"),
        ("output_bags: [{uri: o, topics: [/no]}]", "no topic of the bags is selected"),
        ("a: [", "cannot read"),
    ],
)
def test_wrong_options_are_reported(tmp_path, convert, options, sentence):
    said = convert(options, write(tmp_path / "a", ("/x", 10, "one")), code=1)
    assert sentence in said
    assert said.count("\n") == 1


@pytest.mark.parametrize("damage", ["missing", "broken", "of another bag"])
def test_reindex_rebuilds_the_metadata(tmp_path, capsys, damage):
    bag = write(tmp_path / "a", ("/x", 10, "one"), ("/x", 30, "three"))
    metadata = bag / FILE_NAME
    right = metadata.read_text()
    metadata.unlink()
    if damage == "broken":
        metadata.write_text("{")
    elif damage == "of another bag":
        metadata.write_text(right.replace("a_0.mcap", "b_0.mcap"))
    assert main(["bag", "reindex", str(bag)]) == 0
    assert capsys.readouterr().out == f"wrote {metadata}: 2 messages\n"
    assert metadata.read_text() == right
    assert read(bag) == [("/x", 10, "one"), ("/x", 30, "three")]


def test_metadata_stay_until_the_new_ones_are_read_back(tmp_path, capsys, monkeypatch):
    bag = write(tmp_path / "a", ("/x", 10, "one"))
    right = (bag / FILE_NAME).read_text()
    half = "".join(right.splitlines(keepends=True)[:-1])
    monkeypatch.setattr("arm_cli.bag_format.metadata.BagMetadata.to_yaml", lambda _: half)
    assert main(["bag", "reindex", str(bag)]) == 1
    assert "is left as it was" in capsys.readouterr().err
    assert (bag / FILE_NAME).read_text() == right
    assert sorted(path.name for path in bag.iterdir()) == ["a_0.mcap", FILE_NAME]


def test_the_formats_are_listed(capsys):
    assert main(["bag", "list", "storage"]) == 0
    assert capsys.readouterr().out == "mcap\n"


@pytest.mark.parametrize("verb", ["component", "daemon", "multicast", "security", "wtf"])
def test_a_verb_of_ros2_that_does_not_exist_here_gets_a_reason(capsys, verb):
    assert main([verb, "list"]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"arm: no verb '{verb}': ")
    assert said.count("\n") == 1
