"""What each topic of a recording said at a time."""

from contextlib import closing

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import Writer

from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.recorded_bag import RecordedBag


def said(recording, topic, time_ns):
    sample = recording.last(topic, time_ns)
    return None if sample is None else sample.data


def test_the_last_message_at_or_before_a_time(write_mcap, opened):
    file = write_mcap([("/a", 10, b"one"), ("/b", 15, b"x"), ("/a", 20, b"two")])
    recording = opened(file)
    assert [said(recording, "/a", at) for at in (9, 10, 19, 20, 99)] == [
        *(None, b"one", b"one", b"two", b"two")
    ]


def test_a_topic_that_spoke_once_long_ago_is_found_behind_many_chunks(write_mcap, opened):
    chunks = [[("/a", 10 * n, b"%d" % n)] for n in range(1, 50)]
    recording = opened(write_mcap([("/once", 1, b"robot")], *chunks))
    assert said(recording, "/once", 480) == b"robot"
    assert said(recording, "/a", 485) == b"48"


def test_it_is_the_same_object_as_long_as_it_is_the_last_one(write_mcap, opened):
    recording = opened(write_mcap([("/a", 10, b"one"), ("/a", 20, b"two")], [("/a", 30, b"x")]))
    first = recording.last("/a", 12)
    assert recording.last("/a", 19) is first
    assert recording.last("/a", 20) is not first
    assert recording.last("/a", 12).data == b"one"


@settings(max_examples=40)
@given(
    chunks=st.lists(
        st.lists(st.tuples(st.sampled_from(["/a", "/b"]), st.integers(1, 60)), min_size=1),
        min_size=1,
        max_size=6,
    ),
    asked=st.lists(st.integers(0, 70), min_size=1, max_size=8),
)
def test_chunks_that_overlap_and_are_not_in_order(tmp_path_factory, chunks, asked):
    path = tmp_path_factory.mktemp("bag") / "a.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=1 << 40)
        writer.start()
        channels = {t: writer.register_channel(t, "cdr", 0) for t in ("/a", "/b")}
        for chunk in chunks:
            for topic, time_ns in chunk:
                writer.add_message(channels[topic], time_ns, b"%d" % time_ns, time_ns)
            writer.flush()
        writer.finish()
    recording = RecordedBag(path)
    times = {t: sorted(at for c in chunks for name, at in c if name == t) for t in ("/a", "/b")}
    for at in asked:
        for topic, known in times.items():
            before = [time_ns for time_ns in known if time_ns <= at]
            found = [sample.time_ns for sample in recording.backwards(topic, at)]
            assert found == before[::-1]
            assert said(recording, topic, at) == (b"%d" % before[-1] if before else None)
    recording.close()


def test_a_folder_with_several_files(write_mcap, opened):
    first = write_mcap([("/a", 10, b"one"), ("/b", 10, b"b")], name="bag/bag_0.mcap")
    write_mcap([("/a", 30, b"two")], name="bag/bag_1.mcap")
    recording = opened(first.parent)
    assert (recording.start_ns, recording.end_ns) == (10, 30)
    assert [said(recording, "/a", at) for at in (29, 30)] == [b"one", b"two"]
    assert recording.topics["/a"].count == 2
    assert said(recording, "/b", 30) == b"b"


def test_a_topic_of_several_types_has_none(write_mcap, opened):
    folder = write_mcap([("/a", 10, b"one")], name="bag/bag_0.mcap").parent
    write_mcap([("/a", 20, b"two")], name="bag/bag_1.mcap", kind="std_msgs/msg/Float64")
    assert opened(folder).topics["/a"].type == ""


@pytest.mark.parametrize("compression", ["NONE", "LZ4", "ZSTD"])
def test_compressions(write_mcap, compression, opened):
    recording = opened(write_mcap([("/a", 10, b"one" * 100)], compression=compression))
    assert said(recording, "/a", 10) == b"one" * 100


def refusal(path):
    with pytest.raises(PageRecordingError) as error:
        RecordedBag(path)
    return str(error.value)


def test_what_is_not_a_recording_is_refused_in_a_sentence(tmp_path, write_mcap):
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.mcap").write_text("no bag")
    (tmp_path / "notes.txt").write_text("no bag")
    assert refusal(tmp_path / "gone.mcap") == f"there is no recording {tmp_path}/gone.mcap"
    assert refusal(tmp_path / "empty") == f"the folder {tmp_path}/empty holds no .mcap file"
    assert "cannot be read" in refusal(tmp_path / "text.mcap")
    assert "is not an .mcap file" in refusal(tmp_path / "notes.txt")
    assert refusal(write_mcap(name="none.mcap")).endswith("none.mcap has no messages")


def test_a_file_whose_recorder_was_killed_says_what_mends_it(tmp_path):
    writer = BagWriter(tmp_path / "bag", BagSettings())
    writer.add_topic(BagTopic("/a", "std_msgs/msg/String"), TypeDefinition("", b""))
    writer.write(BagMessage("/a", 10, 10, b"one"))
    writer.flush()
    assert "`arm bag convert` writes it anew" in refusal(tmp_path / "bag")
    writer.abandon()


def test_a_file_that_was_cut_off_is_named(write_mcap):
    cut = write_mcap([("/a", 10, b"one")])
    cut.write_bytes(cut.read_bytes()[:-300])
    assert refusal(cut).startswith(f"{cut} cannot be read: ")


def test_damage_in_a_chunk_is_told_when_it_is_read(write_mcap, opened):
    file = write_mcap([("/a", 10, b"one" * 50)], compression="NONE")
    file.write_bytes(file.read_bytes().replace(b"oneoneone", b"oneXneone", 1))
    recording = opened(file)
    with pytest.raises(PageRecordingError, match="cannot be read"):
        recording.last("/a", 10)


def test_a_topic_that_is_not_there_never_said_anything(write_mcap, opened):
    assert opened(write_mcap([("/a", 10, b"one")])).last("/b", 10) is None


def test_a_recording_gets_longer_by_another_file(write_mcap):
    files = [
        write_mcap([("/a", 0, b"first"), ("/a", 10, b"second")], name="bag/bag_0.mcap"),
        write_mcap([("/a", 20, b"third"), ("/b", 30, b"other")], name="bag/bag_1.mcap"),
    ]
    with closing(RecordedBag(files[0].parent, files[:1])) as bag:
        assert (bag.last("/a", 25).data, bag.end_ns) == (b"second", 10)
        assert not bag.extend(files[:1])
        assert bag.extend(files)
        assert (bag.last("/a", 25).data, bag.last("/a", 5).data) == (b"third", b"first")
        assert (bag.end_ns, bag.topics["/a"].count, list(bag.topics)) == (30, 3, ["/a", "/b"])
