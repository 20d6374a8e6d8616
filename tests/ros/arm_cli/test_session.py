"""How long a command waits for the delivery of its last messages."""

import itertools
from contextlib import suppress
from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest
from rclpy.task import Future

from arm_cli.errors import CommandUsageError, StoppedError, UnansweredError
from arm_cli.names import absolute_name
from arm_cli.ros import session as session_module
from arm_cli.ros.session import ACKNOWLEDGE_TIMEOUT_S, open_session


class Clock:
    """A time that goes on by a little with each look at it."""

    def __init__(self) -> None:
        self._looks = itertools.count()
        self._passed_s = 0.0

    def monotonic(self) -> float:
        return self._passed_s + 0.005 * next(self._looks)

    def pass_by(self, seconds: float) -> None:
        self._passed_s += seconds


@pytest.fixture
def clock(monkeypatch) -> Clock:
    """The time of sessions."""
    clock = Clock()
    monkeypatch.setattr(session_module, "time", SimpleNamespace(monotonic=clock.monotonic))
    return clock


@dataclass
class PublisherOf:
    """A fake publisher whose readers acknowledge late, or never."""

    clock: Clock
    readers: int
    acknowledged_after_s: float
    waited_s: list[float] = field(default_factory=list)

    def get_subscription_count(self) -> int:
        return self.readers

    def wait_for_all_acked(self, timeout) -> bool:
        self.waited_s.append(timeout.nanoseconds * 1e-9)
        self.clock.pass_by(min(self.acknowledged_after_s, self.waited_s[-1]))
        return self.acknowledged_after_s <= self.waited_s[-1]


def test_a_command_waits_until_its_last_messages_are_acknowledged(clock):
    late, in_time, unread = (PublisherOf(clock, *each) for each in ((1, 0.2), (2, 0.0), (0, 0.0)))
    with open_session() as session:
        session.wait_for_delivery([late, in_time, unread], 0.01)
    assert late.waited_s == [pytest.approx(ACKNOWLEDGE_TIMEOUT_S, abs=0.1)]
    assert len(in_time.waited_s) == 1
    assert in_time.waited_s[0] <= ACKNOWLEDGE_TIMEOUT_S - 0.2
    assert unread.waited_s == []


def test_readers_that_never_acknowledge_delay_a_command_by_a_second_at_most(clock):
    first, second = (PublisherOf(clock, 1, float("inf")) for _ in range(2))
    with open_session() as session:
        session.wait_for_delivery([first, second], 0.01)
    assert len(first.waited_s) == 1
    assert sum(first.waited_s + second.waited_s) <= ACKNOWLEDGE_TIMEOUT_S


@pytest.mark.parametrize("name", ["my topic", "/7th", "/", "/a//b", "/a{b}", "~/a"])
def test_an_invalid_ros_name_is_reported(name):
    with pytest.raises(CommandUsageError) as error, open_session() as session:
        session.full_name(name)
    assert str(error.value).startswith(f"'{absolute_name(name)}': Invalid topic name: topic name")
    assert not {"\n", "^"} & set(str(error.value))
    assert str(error.value)[-1] != ":"


def test_an_invalid_node_name_is_reported():
    with (
        pytest.raises(CommandUsageError, match=r"^'a b': Invalid node name: "),
        open_session("a b"),
    ):
        pass


def test_a_relative_name_becomes_absolute():
    with open_session() as session:
        assert session.full_name("_hidden/joint_states") == "/_hidden/joint_states"
        assert session.full_name("/tf") == "/tf"


def test_a_host_that_does_not_exist_is_reported(monkeypatch):
    monkeypatch.setenv("ROS_STATIC_PEERS", "no such host")
    with (
        pytest.raises(CommandUsageError, match=r"^cannot start ROS: .*peer no such host$"),
        open_session(),
    ):
        pass


@pytest.mark.parametrize(("error", "code"), [(None, 0), (StoppedError(15), 15), (OSError(), 1)])
def test_the_node_s_end_is_limited_in_time(error, code, monkeypatch):
    calls = []

    class Limit:
        def start(self, exit_code):
            calls.append(exit_code)

        def cancel(self):
            calls.append("cancelled")

    monkeypatch.setattr(session_module, "DestructionLimit", Limit)
    with suppress(StoppedError, OSError), open_session():
        if error is not None:
            raise error
    assert calls == [code, "cancelled"]


def test_a_command_without_a_time_limit_ends_with_the_server_that_it_waits_for():
    there = iter([True, True])
    with (
        open_session() as session,
        pytest.raises(UnansweredError, match=r"^no answer from /grip: its server has ended$"),
    ):
        session.answer(Future(), "/grip", lambda: next(there, False))
    assert next(there, None) is None


def test_the_last_answer_of_a_server_that_has_ended_counts():
    future = Future()
    answers = iter([None, "done"])

    def is_there() -> bool:
        if answer := next(answers, None):
            future.set_result(answer)
        return False

    with open_session() as session:
        assert session.answer(future, "/grip", is_there) == "done"
