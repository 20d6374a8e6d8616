"""The prompt: lines from a descriptor, what a person may type, and the answers."""

import os
import threading
from collections.abc import Callable, Iterator

import pytest

from arm_controller.errors import CommandLineError, DeliveryError, PoseError
from arm_controller.joint_pose import JointPose
from arm_controller.terminal import InputLines, TerminalDialogue, parse_pose_line, prompt


class Pipe:
    """A pipe to type into, and the lines at its other end."""

    def __init__(self) -> None:
        self.read_end, self._write_end = os.pipe()
        self.lines = InputLines(self.read_end)

    def type(self, data: bytes) -> None:
        os.write(self._write_end, data)

    def close_input(self) -> None:
        if self._write_end >= 0:
            os.close(self._write_end)
            self._write_end = -1


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    made = Pipe()
    with made.lines:
        yield made
    made.close_input()
    os.close(made.read_end)


def test_reads_line_by_line_however_the_input_is_cut(pipe):
    pipe.type(b"one\ntwo\r\nthr")
    assert pipe.lines.read_line() == "one"
    assert pipe.lines.read_line() == "two"
    pipe.type(b"ee\n")
    assert pipe.lines.read_line() == "three"


def test_a_last_line_without_a_line_break_is_used(pipe):
    pipe.type(b"one\n\nlast")
    pipe.close_input()
    assert [pipe.lines.read_line() for _ in range(4)] == ["one", "", "last", None]


def test_the_end_of_input_stays_the_end(pipe):
    pipe.close_input()
    assert pipe.lines.read_line() is None
    assert pipe.lines.read_line() is None


def test_bytes_that_are_not_text_do_not_raise(pipe):
    pipe.type(b"\xff\xfe 1\n")
    assert pipe.lines.read_line() == "\ufffd\ufffd 1"


def test_a_blocked_reader_can_be_ended(pipe):
    results: list[str | None] = []
    reader = threading.Thread(target=lambda: results.append(pipe.lines.read_line()))
    reader.start()
    pipe.lines.end()
    reader.join(timeout=10.0)
    assert not reader.is_alive()
    assert results == [None]


def test_nothing_more_is_read_after_the_end(pipe):
    pipe.type(b"one\ntwo\n")
    assert pipe.lines.read_line() == "one"
    pipe.lines.end()
    assert pipe.lines.read_line() is None


def test_a_descriptor_that_cannot_be_read_is_the_end_of_input(tmp_path):
    descriptor = os.open(tmp_path, os.O_RDONLY)
    with InputLines(descriptor) as lines:
        assert lines.read_line() is None
    os.close(descriptor)


JOINTS = ("j0", "j1", "j2", "j3")


def test_the_prompt_says_how_many_numbers():
    assert prompt(JOINTS) == "Enter the 4 Joint Variables to send (separated by spaces): "


@pytest.mark.parametrize("line", ["0.1 -2 .3 1e-1", "  0.1\t-2   0.3 0.1  "])
def test_takes_numbers_separated_by_any_blanks(line):
    assert parse_pose_line(line, JOINTS).positions == (0.1, -2.0, 0.3, 0.1)


@pytest.mark.parametrize("line", ["", "1 2 3", "1 2 3 4 5"])
def test_wants_as_many_numbers_as_joints(line):
    with pytest.raises(CommandLineError, match=r"^Please enter exactly 4 numbers\."):
        parse_pose_line(line, JOINTS)


def test_says_which_word_is_not_a_number():
    with pytest.raises(CommandLineError, match=r"exactly 4 numbers\. \('two' is not a number\.\)"):
        parse_pose_line("1 two 3 4", JOINTS)


def test_refuses_nan():
    with pytest.raises(PoseError, match="joint 'j1'"):
        parse_pose_line("1 nan 3 4", JOINTS)


PROMPT = "Enter the 2 Joint Variables to send (separated by spaces): "
UNREACHABLE = 9.0
UNHEARD = 5.0


class Conversation:
    """The output and the messages for these lines."""

    def __init__(self, *lines: str) -> None:
        self.shown = ""
        self.sent: list[tuple[float, ...]] = []
        self._lines = list(lines)
        dialogue = TerminalDialogue(("j0", "j1"), self._read_line, self._write, self._deliver)
        self.all_delivered = dialogue.run()

    def _read_line(self) -> str | None:
        return self._lines.pop(0) if self._lines else None

    def _write(self, text: str) -> None:
        self.shown += text

    def _deliver(self, pose: JointPose, announce: Callable[[], None]) -> None:
        if pose.positions[0] == UNREACHABLE:
            raise PoseError("joint 'j0' cannot go to 9 rad")
        if pose.positions[0] == UNHEARD:
            raise DeliveryError("Not published: nobody listens.")
        announce()
        self.sent.append(pose.positions)


def test_publishes_each_line_once():
    talk = Conversation("0.5 1", "0 0")
    assert talk.sent == [(0.5, 1.0), (0.0, 0.0)]
    assert talk.shown == (
        f"{PROMPT}Publishing: [0.500000, 1.000000]\n"
        f"{PROMPT}Publishing: [0.000000, 0.000000]\n"
        f"{PROMPT}\n"
    )
    assert talk.all_delivered


def test_ends_at_the_end_of_input():
    assert Conversation().shown == f"{PROMPT}\n"


def test_an_invalid_line_is_explained_and_the_next_one_is_used():
    talk = Conversation("1 2 3", "0 0")
    assert "Please enter exactly 2 numbers. (There were 3.)\n" in talk.shown
    assert talk.sent == [(0.0, 0.0)]
    assert talk.all_delivered


def test_a_pose_beyond_the_limits_is_explained_and_not_announced():
    talk = Conversation("9 0")
    assert "joint 'j0' cannot go to 9 rad\n" in talk.shown
    assert "Publishing" not in talk.shown
    assert talk.all_delivered


def test_a_pose_without_a_subscriber_makes_the_result_a_failure():
    talk = Conversation("5 0", "0 0")
    assert "Not published: nobody listens.\n" in talk.shown
    assert talk.sent == [(0.0, 0.0)]
    assert not talk.all_delivered
