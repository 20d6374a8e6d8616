"""A recording under way: what happens when the disk is slow, or full."""

import subprocess
import sys
import threading

import pytest

from arm_cli.bag.bag_reader import BagReader
from arm_cli.bag.bag_topic import BagMessage, BagTopic
from arm_cli.bag.bag_writer import BagSettings, BagWriter
from arm_cli.bag.read_ahead import ReadAhead
from arm_cli.bag.recording import Recording
from arm_cli.bag.type_definition import TypeDefinition
from arm_cli.errors import BagError

TYPE = "std_msgs/msg/Empty"
TOPIC = BagTopic("/x", TYPE)


class SlowWriter(BagWriter):
    """A writer that waits before each message until it may go on."""

    def __init__(self, folder) -> None:
        super().__init__(folder, BagSettings())
        self.begun = threading.Event()
        self.may_go_on = threading.Event()

    def write(self, message) -> None:
        self.begun.set()
        assert self.may_go_on.wait(30.0)
        super().write(message)


class FullDisk(BagWriter):
    """A writer whose disk is full after some messages."""

    def write(self, message) -> None:
        if message.log_time_ns >= 3:
            raise BagError("cannot write /x: No space left on device")
        super().write(message)


def message(number: int, size: int = 10) -> BagMessage:
    return BagMessage("/x", number, number, bytes(size))


def test_messages_are_written_in_order(tmp_path):
    recording = Recording(BagWriter(tmp_path / "bag", BagSettings()), 1000)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    for number in range(20):
        recording.put(message(number))
    assert recording.finish().message_count == 20
    assert not recording.dropped
    reader = BagReader(tmp_path / "bag")
    assert [m.log_time_ns for m in reader.messages(["/x"])] == list(range(20))
    reader.close()


def test_what_does_not_fit_into_the_cache_is_dropped_and_counted(tmp_path):
    writer = SlowWriter(tmp_path / "bag")
    recording = Recording(writer, 100)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    recording.put(message(0, 60))
    assert writer.begun.wait(30.0)
    for number in range(1, 6):
        recording.put(message(number, 40))
    writer.may_go_on.set()
    assert recording.finish().message_count == 2
    assert recording.dropped == {"/x": 4}


def test_a_message_larger_than_the_cache_is_written_all_the_same(tmp_path):
    recording = Recording(BagWriter(tmp_path / "bag", BagSettings()), 100)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    recording.put(message(0, 5000))
    assert recording.finish().message_count == 1


class Listing(BagWriter):
    """A writer that lists the messages."""

    def __init__(self, folder) -> None:
        super().__init__(folder, BagSettings())
        self.written: list[int] = []

    def write(self, message) -> None:
        super().write(message)
        self.written.append(message.log_time_ns)


def test_without_a_cache_each_message_is_written_at_once(tmp_path):
    writer = Listing(tmp_path / "bag")
    recording = Recording(writer, 0)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    for number in range(200):
        recording.put(message(number))
        assert writer.written == list(range(number + 1))
    assert recording.finish().message_count == 200
    assert not recording.dropped


def test_without_a_cache_a_full_disk_is_known_at_once(tmp_path):
    recording = Recording(FullDisk(tmp_path / "bag", BagSettings()), 0)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    for number in range(5):
        recording.put(message(number))
        assert (recording.failure is not None) == (number >= 3)
    with pytest.raises(BagError, match="No space left on device"):
        recording.finish()


def test_a_full_disk_ends_the_recording(tmp_path):
    recording = Recording(FullDisk(tmp_path / "bag", BagSettings()), 1000)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, ""))
    for number in range(5):
        recording.put(message(number))
    with pytest.raises(BagError, match="No space left on device"):
        recording.finish()
    assert recording.failure is not None


def test_a_file_that_cannot_grow_is_a_sentence_and_keeps_what_fits(tmp_path):
    # A limit of the size of files stands for the end of the disk; it holds for the whole process.
    code = """
import resource, sys
from pathlib import Path
from arm_cli.bag.bag_topic import BagMessage, BagTopic
from arm_cli.bag.bag_writer import BagSettings, BagWriter
from arm_cli.bag.recording import Recording
from arm_cli.bag.type_definition import TypeDefinition
from arm_cli.errors import BagError
resource.setrlimit(resource.RLIMIT_FSIZE, (2_000_000, 2_000_000))
recording = Recording(BagWriter(Path("bag"), BagSettings()), 10**8)
recording.add_topic(BagTopic("/x", "t/msg/T"), TypeDefinition("t/msg/T", ""))
for number in range(5):
    recording.put(BagMessage("/x", number, number, bytes(800_000)))
try:
    recording.finish()
except BagError as error:
    print(error)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=True
    )
    assert (done.stdout, done.stderr) == ("cannot write bag: File too large\n", "")
    with BagReader(tmp_path / "bag") as reader:
        assert reader.metadata.message_count == 2


def test_reading_ahead_hands_on_everything():
    messages = [message(number) for number in range(50)]
    with ReadAhead(iter(messages), 3) as ahead:
        assert list(ahead) == messages


def test_reading_ahead_can_be_left_before_the_end():
    with ReadAhead((message(number) for number in range(10**9)), 3) as ahead:
        assert next(iter(ahead)) == message(0)


def test_reading_ahead_hands_on_what_went_wrong_after_what_was_read():
    def damaged():
        yield message(0)
        raise BagError("is damaged")

    with ReadAhead(damaged(), 3) as ahead:
        found = iter(ahead)
        assert next(found) == message(0)
        with pytest.raises(BagError, match="is damaged"):
            next(found)
