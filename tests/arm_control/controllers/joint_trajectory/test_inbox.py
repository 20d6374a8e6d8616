"""Requests between the client and the control loop, which may stop the controller meanwhile."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

import pytest

from arm_control.controllers.joint_trajectory.goals import (
    GoalCancel,
    GoalRequest,
    Inbox,
    TrajectoryReplacement,
    not_running,
)
from arm_control.controllers.joint_trajectory.trajectory import Trajectory

POINT = [(0.5, [1.0, 2.0, 3.0])]


@pytest.fixture
def inbox() -> Inbox:
    inbox = Inbox()
    inbox.open()
    return inbox


@pytest.fixture
def replacement(make_request) -> Callable[[], TrajectoryReplacement]:
    return lambda: TrajectoryReplacement(Trajectory(make_request([(1.0, [0.0])], ["j"]), ["j"]))


def test_a_stream_of_trajectories_does_not_pile_up(inbox, replacement):
    newest = replacement()
    for request in (replacement(), replacement(), newest):
        inbox.put(request)
    assert inbox.take() == [newest]


def test_other_requests_stay_where_they_are(inbox, replacement):
    for request in (replacement(), GoalCancel(1), replacement()):
        inbox.put(request)
    assert [type(request) for request in inbox.take()] == [
        TrajectoryReplacement,
        GoalCancel,
        TrajectoryReplacement,
    ]


def test_a_goal_ends_once_whenever_the_controller_stops(make_rig, make_request):
    """A goal is refused, or it has a result: never both, never neither."""
    together = Barrier(2, timeout=60.0)

    def submit(rig: Any) -> Any:
        together.wait()
        return rig.controller.submit_goal(GoalRequest("goal", make_request(POINT)))

    with ThreadPoolExecutor(1) as client:
        for _ in range(200):
            rig = make_rig()
            refusal = client.submit(submit, rig)
            together.wait()
            rig.deactivate()
            ended = (refusal.result(60.0), rig.result)
            assert ended.count(None) == 1
            assert ended[0] in (None, not_running("").as_result())
