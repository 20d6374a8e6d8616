"""A running recording: a slow or full disk, lost messages, and quality of service."""

import threading
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from run_python import run_python

from arm_cli.bag.ros_player import ReadAhead
from arm_cli.bag.ros_recorder import LossCounter, Recording
from arm_cli.bag_format.offered_qos import OfferedQos
from arm_cli.bag_format.reader import BagReader
from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.errors import BagError
from arm_cli.ros.qos import RECORDING_DEPTH, playing_profile, recording_profile

TYPE = "std_msgs/msg/Empty"
TOPIC = BagTopic("/x", TYPE)


class SlowWriter(BagWriter):
    """A writer that waits before each message until the test lets it continue."""

    def __init__(self, folder) -> None:
        super().__init__(folder, BagSettings())
        self.begun = threading.Event()
        self.may_go_on = threading.Event()

    def write(self, message) -> None:
        self.begun.set()
        assert self.may_go_on.wait(30.0)
        super().write(message)


class FullDisk(BagWriter):
    """A writer whose disk becomes full after three messages."""

    def write(self, message) -> None:
        if message.log_time_ns >= 3:
            raise BagError("cannot write /x: No space left on device")
        super().write(message)


def message(number: int, size: int = 10) -> BagMessage:
    return BagMessage("/x", number, number, bytes(size))


def test_messages_are_written_in_order(tmp_path):
    recording = Recording(BagWriter(tmp_path / "bag", BagSettings()), 1000)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
    for number in range(20):
        recording.put(message(number))
    assert recording.finish().message_count == 20
    assert not recording.dropped
    reader = BagReader(tmp_path / "bag")
    assert [m.log_time_ns for m in reader.messages(["/x"])] == list(range(20))
    reader.close()


def test_messages_that_do_not_fit_into_the_cache_are_dropped_and_counted(tmp_path):
    writer = SlowWriter(tmp_path / "bag")
    recording = Recording(writer, 100)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
    recording.put(message(0, 60))
    assert writer.begun.wait(30.0)
    for number in range(1, 6):
        recording.put(message(number, 40))
    writer.may_go_on.set()
    assert recording.finish().message_count == 2
    assert recording.dropped == {"/x": 4}


def test_a_message_larger_than_the_cache_is_written(tmp_path):
    recording = Recording(BagWriter(tmp_path / "bag", BagSettings()), 100)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
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
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
    for number in range(200):
        recording.put(message(number))
        assert writer.written == list(range(number + 1))
    assert recording.finish().message_count == 200
    assert not recording.dropped


def test_without_a_cache_a_full_disk_is_reported_at_once(tmp_path):
    recording = Recording(FullDisk(tmp_path / "bag", BagSettings()), 0)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
    for number in range(5):
        recording.put(message(number))
        assert (recording.failure is not None) == (number >= 3)
    with pytest.raises(BagError, match="No space left on device"):
        recording.finish()


def test_a_full_disk_ends_the_recording(tmp_path):
    recording = Recording(FullDisk(tmp_path / "bag", BagSettings()), 1000)
    recording.add_topic(TOPIC, TypeDefinition(TYPE, b""))
    for number in range(5):
        recording.put(message(number))
    with pytest.raises(BagError, match="No space left on device"):
        recording.finish()
    assert recording.failure is not None


def test_a_file_that_cannot_grow_keeps_its_messages_and_is_reported(tmp_path):
    # A file size limit simulates a full disk; it applies to the whole process.
    code = """
import resource, sys
from pathlib import Path
from arm_cli.bag_format.topic import BagMessage, BagTopic
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.bag.ros_recorder import Recording
from arm_cli.bag_format.topic import TypeDefinition
from arm_cli.errors import BagError
resource.setrlimit(resource.RLIMIT_FSIZE, (2_000_000, 2_000_000))
recording = Recording(BagWriter(Path("bag"), BagSettings()), 10**8)
recording.add_topic(BagTopic("/x", "t/msg/T"), TypeDefinition("t/msg/T", b""))
for number in range(5):
    recording.put(BagMessage("/x", number, number, bytes(800_000)))
try:
    recording.finish()
except BagError as error:
    print(error)
"""
    done = run_python("-c", code, cwd=tmp_path, check=True)
    assert (done.stdout, done.stderr) == ("cannot write bag: File too large\n", "")
    with BagReader(tmp_path / "bag") as reader:
        assert reader.metadata.message_count == 2


def test_read_ahead_yields_every_message():
    messages = [message(number) for number in range(50)]
    with ReadAhead(iter(messages), 3) as ahead:
        assert list(ahead) == messages


def test_read_ahead_can_be_stopped_early():
    with ReadAhead((message(number) for number in range(10**9)), 3) as ahead:
        assert next(iter(ahead)) == message(0)


def test_read_ahead_raises_an_error_after_the_messages_before_it():
    def damaged():
        yield message(0)
        raise BagError("is damaged")

    with ReadAhead(damaged(), 3) as ahead:
        found = iter(ahead)
        assert next(found) == message(0)
        with pytest.raises(BagError, match="is damaged"):
            next(found)


def test_different_offers_become_the_strongest_of_each_policy():
    profile = playing_profile(
        [
            OfferedQos(depth=3, reliability="best_effort", durability="transient_local"),
            OfferedQos(depth=20),
        ]
    )
    assert profile.reliability == ReliabilityPolicy.RELIABLE
    assert profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert (profile.history, profile.depth) == (HistoryPolicy.KEEP_LAST, 20)


def test_an_override_replaces_the_offer():
    weak = OfferedQos(reliability="best_effort", depth=1)
    profile = recording_profile([], weak)
    assert profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert profile.depth == RECORDING_DEPTH
    latched = recording_profile([], OfferedQos(durability="transient_local"))
    assert latched.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert latched.reliability == ReliabilityPolicy.RELIABLE


def test_keep_all_is_played_as_keep_all():
    assert playing_profile([OfferedQos(history="keep_all")]).history == HistoryPolicy.KEEP_ALL


def missing(numbers: list[int], publishers: int = 1) -> int:
    counted = LossCounter(lambda: publishers)
    return sum(counted.missing_before(number) for number in numbers)


def test_messages_before_the_first_are_not_lost():
    assert missing([41, 42, 43]) == 0


def test_gaps_are_counted():
    assert missing([1, 2, 5, 6, 10]) == 2 + 3


def test_a_restarted_publisher_loses_nothing():
    assert missing([98, 99, 1, 2, 3]) == 0
    assert missing([98, 99, 1, 2, 5]) == 2


def test_publishers_that_join_lose_nothing():
    publishers = 1
    counted = LossCounter(lambda: publishers)
    assert counted.missing_before(10) == 0
    publishers = 2
    assert [counted.missing_before(n) for n in (700, 11, 701, 12)] == [0, 0, 0, 0]


STREAMS = st.lists(
    st.lists(st.booleans(), max_size=40).map(lambda came: [True, *came, True]),
    min_size=1,
    max_size=4,
)


def found_in(streams: list[list[bool]], firsts: list[int], random: Random) -> int:
    """Return the number of messages counted as lost, from the arrivals of each publisher."""
    waiting = [
        [first + i for i, came in enumerate(flags) if came]
        for first, flags in zip(firsts, streams, strict=True)
    ]
    counted = LossCounter(lambda: len(streams))
    # The first message of each publisher comes first, so that all publishers are known.
    found = sum(counted.missing_before(numbers.pop(0)) for numbers in waiting)
    while any(waiting):
        numbers = random.choice([numbers for numbers in waiting if numbers])
        found += counted.missing_before(numbers.pop(0))
    return found


@given(STREAMS, st.randoms(use_true_random=False))
def test_gaps_of_publishers_with_distant_numbers_add_up(streams, random):
    firsts = [1000 * (i + 1) for i in range(len(streams))]
    assert found_in(streams, firsts, random) == sum(flags.count(False) for flags in streams)
