"""Messages of ticks: when they are held and sent, and in which order."""

import pytest

from arm_control.loop.outbox import LONGEST_HELD_S, MOST_TICKS, Outbox
from arm_control.testing import ManualClock


class Line:
    """A topic that records messages, and an outbox with a manual clock."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.outbox = Outbox(self.clock)
        self.sent: list[bytes] = []

    def tick(self, *messages: bytes) -> None:
        for message in messages:
            self.outbox.put(self.sent.append, message)
        self.outbox.end_tick()


@pytest.fixture
def line() -> Line:
    return Line()


def test_ticks_without_a_pause_are_sent_together_in_their_order(line):
    messages = [bytes([number]) for number in range(2 * MOST_TICKS)]
    for tick in range(MOST_TICKS - 1):
        line.tick(*messages[2 * tick : 2 * tick + 2])
    assert line.sent == []
    line.tick(*messages[-2:])
    assert line.sent == messages


def test_the_next_burst_is_counted_from_0(line):
    for _ in range(MOST_TICKS):
        line.tick(b"first")
    for _ in range(MOST_TICKS - 1):
        line.tick(b"second")
    assert line.sent == [b"first"] * MOST_TICKS


def test_a_tick_that_comes_after_a_while_is_sent_at_its_end(line):
    for number in range(3):
        line.clock.advance(2 * LONGEST_HELD_S)
        line.tick(bytes([number]))
        assert line.sent[-1] == bytes([number])


def test_what_is_held_goes_out_once(line):
    line.tick(b"held")
    line.outbox.send()
    line.outbox.send()
    assert line.sent == [b"held"]


def test_after_a_message_that_cannot_be_sent_the_outbox_goes_on(line):
    def fail(_: bytes) -> None:
        raise RuntimeError("no such publisher")

    line.outbox.put(fail, b"lost")
    line.outbox.put(line.sent.append, b"dropped")
    with pytest.raises(RuntimeError):
        line.outbox.send()
    line.outbox.put(line.sent.append, b"next")
    line.outbox.send()
    assert line.sent == [b"next"]
