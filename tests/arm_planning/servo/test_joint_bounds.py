from dataclasses import replace
from math import inf

import numpy as np
import pytest
from planning_models import model_of
from robots import joint, link, robot

from arm_planning.errors import PlanningError
from arm_planning.servo.joint_bounds import JointBounds
from arm_planning.servo.status import StatusCode

PERIOD_S = 0.01
LIMIT = {"limits": (-1.0, 1.0), "velocity": 2.0}
TWO = robot(
    link("base"),
    link("a"),
    link("b"),
    joint("first", "base", "a", **LIMIT, kind="revolute"),
    joint("second", "a", "b", **LIMIT, kind="revolute"),
)


@pytest.fixture
def bounds() -> JointBounds:
    group = model_of(TWO, arm=(("first", "second"), "b")).group("arm")
    return JointBounds(group, (0.1,))


def array(*values: float) -> np.ndarray:
    return np.array(values)


def test_joints_stop_before_the_margin_and_reach_it(bounds):
    q, speeds = array(0.0, 0.0), array(0.0, 0.0)
    for _ in range(400):
        wanted, _ = bounds.within_positions(q, array(2.0, 0.0), PERIOD_S, halts_all=True)
        speeds = bounds.ramped(speeds, wanted, PERIOD_S)
        q = q + PERIOD_S * speeds
        assert q[0] <= 0.9 + 1e-9
    assert q[0] == pytest.approx(0.9, abs=1e-3)
    _, reason = bounds.within_positions(q, array(2.0, 0.0), PERIOD_S, halts_all=True)
    assert reason.status.code is StatusCode.JOINT_BOUND
    assert "first" in reason.status.message
    assert "upper" in reason.status.message


def test_a_joint_within_its_margin_may_leave_the_limit(bounds):
    speeds, reason = bounds.within_positions(
        array(0.95, 0.0), array(-1.0, 0.5), PERIOD_S, halts_all=True
    )
    assert speeds.tolist() == [-1.0, 0.5]
    assert reason.factor == 1.0


def test_at_a_limit_all_joints_stop_or_only_that_one(bounds):
    at_limit, wanted = array(0.9, 0.0), array(1.0, 0.5)
    every, _ = bounds.within_positions(at_limit, wanted, PERIOD_S, halts_all=True)
    one, _ = bounds.within_positions(at_limit, wanted, PERIOD_S, halts_all=False)
    assert every == pytest.approx([0.0, 0.0])
    assert one == pytest.approx([0.0, 0.5])


def test_velocity_limits_and_accelerations_keep_the_direction(bounds):
    assert bounds.within_velocities(array(4.0, -1.0)).tolist() == [2.0, -0.5]
    # The group's joints have 3 rad/s^2.
    ramped = bounds.ramped(array(0.0, 0.0), array(2.0, -1.0), PERIOD_S)
    assert ramped == pytest.approx([0.03, -0.015])


def test_no_speed_leads_over_a_limit(bounds):
    assert bounds.kept_inside(array(0.999, 0.0), array(1.0, 1.0), PERIOD_S) == pytest.approx(
        [0.1, 1.0]
    )
    assert bounds.kept_inside(array(1.2, 0.0), array(1.0, 0.0), PERIOD_S).tolist() == [0.0, 0.0]
    assert bounds.kept_inside(array(1.2, 0.0), array(-1.0, 0.0), PERIOD_S).tolist() == [-1.0, 0.0]


def test_margins_that_fit_no_joints_are_refused():
    group = model_of(TWO, arm=(("first", "second"), "b")).group("arm")
    with pytest.raises(PlanningError, match="has 3 numbers; it has one for all joints"):
        JointBounds(group, (0.1, 0.1, 0.1))


def test_a_joint_without_an_acceleration_limit_stops_at_the_margin():
    group = model_of(TWO, arm=(("first", "second"), "b")).group("arm")
    limits = tuple(replace(each, acceleration=inf) for each in group.limits)
    bounds = JointBounds(replace(group, limits=limits), (0.1,))
    speeds, _ = bounds.within_positions(array(0.89, 0.0), array(2.0, 0.0), PERIOD_S, halts_all=True)
    assert 0.0 < speeds[0] < 0.01 / PERIOD_S + 1e-6
