"""The output of `arm bag`, its errors, and its selection of topics and times."""

import json
import time

import pytest

from arm_cli.bag.ros_player import PlaySchedule
from arm_cli.bag.topic_selection import TopicSelection, absolute_names, compile_pattern
from arm_cli.bag_format.metadata import BagMetadata, TimeSpan, read_metadata
from arm_cli.bag_format.offered_qos import (
    OfferedQos,
    QosDuration,
    offers_to_text,
    read_offers,
    read_qos_overrides,
)
from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition, find_definition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.errors import BagError
from arm_cli.interface_types import InterfaceIndex
from arm_cli.main import main

START_NS = 1_700_000_000_123_456_789


@pytest.fixture
def bag(tmp_path):
    writer = BagWriter(tmp_path / "bag", BagSettings())
    for name, type_, count in (("/b", "p/msg/A", 1), ("/a", "p/msg/B", 2)):
        writer.add_topic(
            BagTopic(name, type_, "RIHS01_x", (OfferedQos(),)), TypeDefinition(type_, b"")
        )
        for number in range(count):
            writer.write(BagMessage(name, START_NS + number * 1_500_000_000, 0, b"1234"))
    writer.close()
    return tmp_path / "bag"


def printed(capsys, *words, code=0):
    try:
        ended = main(["bag", *words])
    except SystemExit as exit_:
        ended = exit_.code
    captured = capsys.readouterr()
    assert ended == code, captured
    return captured.out if code == 0 else captured.err


def test_info_has_the_format_of_ros2(capsys, bag):
    lines = printed(capsys, "info", str(bag)).splitlines()
    local = time.strftime("%b %e %Y %H:%M:%S", time.localtime(1_700_000_000))
    assert lines[:2] == ["", "Files:             bag_0.mcap"]
    assert "Storage id:        mcap" in lines
    assert "ROS Distro:        jazzy" in lines
    assert "Duration:          1.500000000s" in lines
    assert f"Start:             {local}.123456789 (1700000000.123456789)" in lines
    assert "Messages:          3" in lines
    first = lines.index(
        "Topic information: Topic: /a | Type: p/msg/B | Count: 2 | Serialization Format: cdr"
    )
    assert lines[first + 1] == (
        "                   Topic: /b | Type: p/msg/A | Count: 1 | Serialization Format: cdr"
    )


def test_info_sorts_as_requested(capsys, bag):
    text = printed(capsys, "info", str(bag), "--sort", "count")
    assert text.index("/b") < text.index("/a")


def test_info_of_names_only(capsys, bag):
    assert set(printed(capsys, "info", "-t", str(bag)).split()) == {"/a", "/b"}


def test_info_as_json(capsys, bag):
    value = json.loads(printed(capsys, "info", "--json", str(bag)))
    assert value["message_count"] == 3
    assert value["duration_s"] == 1.5
    topics = {topic["name"]: topic for topic in value["topics"]}
    assert topics["/a"]["count"] == 2
    assert topics["/a"]["qos"][0]["reliability"] == "reliable"


def test_info_reports_an_unfinished_bag(capsys, bag):
    path = bag / "bag_0.mcap"
    path.write_bytes(path.read_bytes()[:-30])
    assert main(["bag", "info", str(bag)]) == 0
    captured = capsys.readouterr()
    assert "bag_0.mcap was not finished" in captured.err
    assert "Messages:          3" in captured.out


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        ("info /nowhere", 2, "Bag path '/nowhere' does not exist!"),
        ("play /nowhere", 2, "Bag path '/nowhere' does not exist!"),
        ("info {bag}/metadata.yaml", 1, "metadata.yaml is not an MCAP file"),
        ("record", 1, "Need to specify at least one option out of --all"),
        ("record -e '*'", 1, "--regex"),
        ("record -a --node-name a-b", 2, "'a-b' is not a node name: use letters"),
        ("record -a -b -3", 2, "argument -b/--max-bag-size/--max-size"),
        ("play {bag} --rate 0", 2, "argument -r/--rate: '0' is not a number above 0"),
        ("play {bag} --topics /c", 1, "no topic '/c' in {bag}; it has /a, /b"),
        ("play {bag} --exclude-regex .", 1, "no topic of {bag} is selected; it has"),
        ("play {bag} --start-offset 2", 1, "beyond the end of {bag}, which lasts 1.500 s"),
        ("record -a --compression-mode file", 1, "--compression-mode needs a --compression-format"),
        ("record -a --qos-profile-overrides-path /no.yaml", 1, "cannot read /no.yaml: No such"),
        ("play {bag} --remap /a", 2, "--remap '/a' is not OLD:=NEW"),
    ],
)
def test_wrong_arguments_are_reported_before_ros_starts(capsys, bag, words, code, sentence):
    line = [word.strip("'").format(bag=bag) for word in words.split()]
    error = printed(capsys, *line, code=code)
    assert sentence.format(bag=bag) in error
    assert error.count("\n") == 1


def test_a_bag_without_messages_cannot_be_played(capsys, tmp_path):
    BagWriter(tmp_path / "bag", BagSettings()).close()
    error = printed(capsys, "play", str(tmp_path / "bag"), code=1)
    assert "bag has no messages" in error


def test_qos_survives_a_round_trip_through_text():
    offers = (
        OfferedQos(),
        OfferedQos(
            "keep_last", 7, "best_effort", "transient_local", deadline=QosDuration(1, 500_000_000)
        ),
    )
    assert read_offers(offers_to_text(offers)) == offers


def test_qos_of_older_metadata_is_numbers_in_a_text():
    old = (
        "- history: 1\n  depth: 10\n  reliability: 2\n  durability: 1\n"
        "  deadline:\n    sec: 0\n    nsec: 0\n"
        "  lifespan:\n    sec: 2\n    nsec: 5\n  liveliness: 3\n"
        "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
        "  avoid_ros_namespace_conventions: false"
    )
    assert read_offers(old) == (
        OfferedQos(
            "keep_last",
            10,
            "best_effort",
            "transient_local",
            deadline=QosDuration(0, 0),
            lifespan=QosDuration(2, 5),
            liveliness="manual_by_topic",
        ),
    )


@pytest.mark.parametrize(
    ("numbers", "limit_ns"),
    [
        ((0, 0), None),
        ((2147483647, 4294967295), None),
        ((9223372036, 854775807), None),
        ((1, 5), 1_000_000_005),
        ((2147483646, 0), 2147483646 * 10**9),
    ],
)
def test_a_duration_keeps_its_numbers_and_tells_its_limit(numbers, limit_ns):
    duration = QosDuration(*numbers)
    offer = OfferedQos(deadline=duration, lifespan=duration, lease=duration)
    (read,) = read_offers(offers_to_text([offer]))
    assert (read.deadline, read.lifespan, read.lease) == (numbers, numbers, numbers)
    assert read.deadline.limit_ns == limit_ns


@pytest.mark.parametrize("value", ["", "[", None, 3, ["x"], "{}"])
def test_invalid_qos_is_ignored(value):
    assert read_offers(value) == ()


def test_overrides_are_by_topic_and_the_rest_is_default(tmp_path):
    file = tmp_path / "overrides.yaml"
    file.write_text(
        "tf: {reliability: best_effort}\n/x:\n  history: keep_all\n  deadline: {sec: 1, nsec: 5}\n"
    )
    assert read_qos_overrides(file) == {
        "/tf": OfferedQos(reliability="best_effort"),
        "/x": OfferedQos(history="keep_all", deadline=QosDuration(1, 5)),
    }
    assert read_qos_overrides(None) == {}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("- /tf", "has no topics"),
        ("/tf: [", "is not YAML: line 2"),
        ("/tf: 2001-13-45", "a value does not fit its type: month must be"),
        ("/tf: best_effort", "/tf has no policies, such as"),
        ("/tf: {reliabilty: reliable}", "/tf has no policy 'reliabilty'; did you mean"),
        ("/tf: {reliability: best}", "/tf: reliability cannot be 'best'; did you mean"),
    ],
)
def test_invalid_overrides_are_reported(tmp_path, text, sentence):
    file = tmp_path / "overrides.yaml"
    file.write_text(text)
    with pytest.raises(BagError) as error:
        read_qos_overrides(file)
    assert sentence in str(error.value)


def test_metadata_survive_a_round_trip_through_text():
    topic = BagTopic("/a", "p/msg/A", "RIHS01_x", (OfferedQos(),))
    written = BagMetadata((), ((topic, 3),), "jazzy")
    assert read_metadata(written.to_yaml(), "here") == written


def test_a_span_grows_in_both_directions():
    span = TimeSpan().with_time(5).with_time(3).joined(TimeSpan(4, 9)).joined(TimeSpan())
    assert (span, span.duration_ns) == (TimeSpan(3, 9), 6)


def test_a_definition_contains_each_nested_type_once():
    text = find_definition(InterfaceIndex(), "tf2_msgs/msg/TFMessage").text
    own, *_ = text.split("=" * 80)
    assert own.strip().splitlines()[-1] == "geometry_msgs/TransformStamped[] transforms"
    names = [line[5:] for line in text.splitlines() if line.startswith("MSG: ")]
    assert sorted(names) == sorted(set(names))
    assert set(names) == {
        "geometry_msgs/TransformStamped",
        "geometry_msgs/Transform",
        "geometry_msgs/Vector3",
        "geometry_msgs/Quaternion",
        "std_msgs/Header",
        "builtin_interfaces/Time",
    }
    assert "=" * 80 + "\nMSG: std_msgs/Header\n" in text


def test_a_type_that_is_not_installed_has_no_definition():
    definition = find_definition(InterfaceIndex(), "no_msgs/msg/No")
    assert (definition.text, definition.encoding) == ("", "")


@pytest.mark.parametrize(
    ("selection", "wanted"),
    [
        (TopicSelection(every=True), ["/a", "/b/c"]),
        (TopicSelection(every=True, hidden=True), ["/a", "/b/c", "/_x"]),
        (TopicSelection(names=absolute_names(["a", "/_x"])), ["/a", "/_x"]),
        (TopicSelection(pattern=compile_pattern("c$", "--regex")), ["/b/c"]),
        (TopicSelection(every=True, excluded_names=frozenset(["/a"])), ["/b/c"]),
        (TopicSelection(every=True, excluded_pattern=compile_pattern("/b", "-x")), ["/a"]),
    ],
)
def test_topics_are_selected(selection, wanted):
    assert [name for name in ("/a", "/b/c", "/_x") if selection.wants(name)] == wanted


def test_bag_times_and_clock_times_convert():
    schedule = PlaySchedule(1_000_000_000, 50.0, 2.0)
    assert schedule.due_s(4_000_000_000) == 51.5
    assert schedule.bag_time_ns(51.5) == 4_000_000_000


def test_a_recording_is_ended_from_outside(capsys, tmp_path):
    folder = tmp_path / "none"
    for words in (("--duration", "3"), ("--duration=3",)):
        text = printed(capsys, "record", "-a", "-o", str(folder), *words, code=2)
        assert "no option --duration: end a recording with Ctrl-C, or after 3 s with" in text
        assert "timeout 3 arm bag record" in text
        assert "--max-bag-duration" in text
    assert not folder.exists()
