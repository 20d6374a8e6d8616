"""The conversation at the prompt."""

from collections.abc import Callable

from arm_controller.errors import DeliveryError, PoseError
from arm_controller.pose import JointPose
from arm_controller.terminal_dialogue import TerminalDialogue

PROMPT = "Enter the 2 Joint Variables to send (separated by spaces): "
UNREACHABLE = 9.0
UNHEARD = 5.0


class Conversation:
    """What was shown and sent for these lines."""

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


def test_a_wrong_line_is_explained_and_the_next_one_counts():
    talk = Conversation("1 2 3", "0 0")
    assert "Please enter exactly 2 numbers. (There were 3.)\n" in talk.shown
    assert talk.sent == [(0.0, 0.0)]
    assert talk.all_delivered


def test_a_pose_beyond_the_limits_is_explained_and_not_announced():
    talk = Conversation("9 0")
    assert "joint 'j0' cannot go to 9 rad\n" in talk.shown
    assert "Publishing" not in talk.shown
    assert talk.all_delivered


def test_a_pose_that_nobody_took_makes_the_result_a_failure():
    talk = Conversation("5 0", "0 0")
    assert "Not published: nobody listens.\n" in talk.shown
    assert talk.sent == [(0.0, 0.0)]
    assert not talk.all_delivered
