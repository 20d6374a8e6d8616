"""Types whose definitions differ from one bag to the next, or are not ROS 2's."""

import json
import struct
from pathlib import Path

import pytest
from mcap.reader import NonSeekingReader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_typestore

from arm_cli.bag_format.topic import TypeDefinition, find_definition
from arm_cli.interface_types import InterfaceIndex
from arm_cli.main import main

STORE = get_typestore(Stores.ROS2_JAZZY)
GRIP = "grip_msgs/msg/Grip"
HEADER = b"\x00\x01\x00\x00"
ONE = ("float64 force", HEADER + struct.pack("<d", 2.5))
TWO = ("float32 force\nfloat32 torque", HEADER + struct.pack("<ff", 2.5, 0.25))
IDL = "=" * 80 + "\nIDL: grip_msgs/msg/Grip\nmodule grip_msgs { module msg {\n"
IDL += "struct Grip { double force; };\n}; };"


def write(
    file: Path,
    *topics: tuple[str, str, bytes],
    encoding: str = "ros2msg",
    message_encoding: str = "cdr",
    kind: str = GRIP,
) -> Path:
    """Write a file with a message of each topic: its name, the definition, the message."""
    with file.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2", "somebody")
        for time_ns, (topic, definition, message) in enumerate(topics, start=1):
            schema = writer.register_schema(kind, encoding, definition.encode())
            channel = writer.register_channel(topic, message_encoding, schema)
            writer.add_message(channel, time_ns, message, time_ns)
        writer.finish()
    return file


def convert(tmp_path: Path, *bags: Path, code: int = 0, more: str = "") -> Path:
    out = tmp_path / "out"
    options = tmp_path / "options.yaml"
    options.write_text(f"output_bags: [{{uri: {out}, all_topics: true{more}}}]")
    words = [word for bag in bags for word in ("-i", str(bag))]
    assert main(["bag", "convert", *words, "-o", str(options)]) == code
    return out / "out_0.mcap"


def decoded(file: Path) -> dict[str, dict[str, float]]:
    with file.open("rb") as stream:
        reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
        return {
            one.channel.topic: {
                name: getattr(one.decoded_message, name)
                for name in ("force", "torque")
                if hasattr(one.decoded_message, name)
            }
            for one in reader.iter_decoded_messages()
        }


def test_two_definitions_of_a_type_are_both_kept(tmp_path):
    old = write(tmp_path / "old.mcap", ("/left", *ONE))
    new = write(tmp_path / "new.mcap", ("/right", *TWO))
    out = convert(tmp_path, old, new)
    assert decoded(out) == {"/left": {"force": 2.5}, "/right": {"force": 2.5, "torque": 0.25}}


def test_two_definitions_cannot_become_one_topic(tmp_path, capsys):
    bags = [write(tmp_path / f"{i}.mcap", ("/x", *one)) for i, one in enumerate((ONE, TWO))]
    convert(tmp_path, *bags, code=1)
    assert f"/x: the bags define {GRIP} differently" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("verb", ["play", "convert"])
def test_a_file_with_two_definitions_of_a_topic_is_only_shown(tmp_path, capsys, verb):
    bag = write(tmp_path / "bag.mcap", ("/x", *ONE), ("/x", *TWO), ("/y", *TWO))
    assert main(["bag", "info", "--json", str(bag)]) == 0
    topics = json.loads(capsys.readouterr().out)["topics"]
    assert [(one["name"], one["count"]) for one in topics] == [("/x", 1), ("/x", 1), ("/y", 1)]
    if verb == "play":
        assert main(["bag", "play", str(bag)]) == 1
    else:
        convert(tmp_path, bag, code=1)
        assert decoded(convert(tmp_path, bag, more=", exclude_topics: [/x]")).keys() == {"/y"}
    assert "/x" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("encoding", "message_encoding", "definition"),
    [
        ("ros2idl", "cdr", IDL),
        ("jsonschema", "json", '{"type": "object"}'),
        ("protobuf", "protobuf", "\n\x80binary"),
        ("", "cdr", ""),
    ],
)
def test_every_schema_is_converted_as_it_is(tmp_path, encoding, message_encoding, definition):
    bag = write(
        tmp_path / "bag.mcap",
        ("/x", definition, b"{}\xff"),
        encoding=encoding,
        message_encoding=message_encoding,
    )
    with convert(tmp_path, bag).open("rb") as stream:
        ((schema, channel, message),) = NonSeekingReader(stream).iter_messages()
    assert schema is not None
    assert (schema.name, schema.encoding, schema.data) == (GRIP, encoding, definition.encode())
    assert (channel.message_encoding, message.data) == (message_encoding, b"{}\xff")


def test_a_channel_without_a_schema_is_converted(tmp_path):
    with (tmp_path / "bag.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        writer.add_message(writer.register_channel("/x", "json", 0), 1, b"{}", 1)
        writer.finish()
    with convert(tmp_path, tmp_path / "bag.mcap").open("rb") as stream:
        ((schema, channel, message),) = NonSeekingReader(stream).iter_messages()
    assert (schema, channel.topic, message.data) == (None, "/x", b"{}")


def test_comments_constants_and_defaults_do_not_make_another_definition():
    plain = TypeDefinition("p/msg/A", b"std_msgs/Header header\nbyte[] data")
    dressed = TypeDefinition(
        "p/msg/A",
        b"# what\nuint8 NONE=0\nstd_msgs/msg/Header  header # when\nuint8[]  data [1, 2]\n",
    )
    assert not plain.contradicts(dressed)
    assert plain.contradicts(TypeDefinition("p/msg/A", b"byte[] data\nstd_msgs/Header header"))
    assert not plain.contradicts(TypeDefinition("p/msg/A", b""))


def test_definitions_of_another_generator_are_the_installed_ones():
    index, compared = InterfaceIndex(), 0
    for name in STORE.fielddefs:
        installed = find_definition(index, name)
        if installed.data:
            text = STORE.generate_msgdef(name, ros_version=2)[0]
            assert not installed.contradicts(TypeDefinition(name, text.encode())), name
            compared += 1
    assert compared > 100
