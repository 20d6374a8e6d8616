"""Requests on their way to the control loop."""

from collections.abc import Callable
from typing import Any

import pytest

from arm_control.joint_trajectory.inbox import GoalCancel, Inbox, Replacement
from arm_control.joint_trajectory.trajectory import Trajectory


@pytest.fixture
def replacement(make_request: Callable[..., Any]) -> Callable[[], Replacement]:
    return lambda: Replacement(Trajectory(make_request([(1.0, [0.0])], ["j"]), ["j"]))


def test_takes_nothing_until_it_is_opened():
    inbox = Inbox()

    assert not inbox.put(GoalCancel(1))
    assert not inbox


def test_keeps_the_order():
    inbox = Inbox()
    inbox.open()
    inbox.put(GoalCancel(1))
    inbox.put(GoalCancel(2))

    assert inbox.take() == [GoalCancel(1), GoalCancel(2)]
    assert inbox.take() == []


def test_returns_what_is_left_when_it_closes():
    inbox = Inbox()
    inbox.open()
    inbox.put(GoalCancel(1))

    assert inbox.close() == [GoalCancel(1)]
    assert not inbox.put(GoalCancel(2))


def test_a_stream_of_trajectories_does_not_pile_up(replacement: Callable[[], Replacement]):
    inbox = Inbox()
    inbox.open()
    newest = replacement()
    for request in (replacement(), replacement(), newest):
        inbox.put(request)

    assert inbox.take() == [newest]


def test_other_requests_stay_where_they_are(replacement: Callable[[], Replacement]):
    inbox = Inbox()
    inbox.open()
    for request in (replacement(), GoalCancel(1), replacement()):
        inbox.put(request)

    assert [type(request) for request in inbox.take()] == [Replacement, GoalCancel, Replacement]
