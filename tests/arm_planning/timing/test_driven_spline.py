import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_control.controllers.joint_trajectory.profiles import Spline
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.driven_spline import (
    DrivenSpline,
    chord_deviation,
    limit_violation,
    remaining,
)
from arm_planning.timing.parameterize import parameterize
from arm_planning.trajectory import TimedTrajectory

WHOLE = parameterize(
    [[0.0, 0.0], [1.0, 0.2], [0.5, 1.0]],
    [PlanningLimits(-3.0, 3.0, 1.0, 2.0)] * 2,
    joints=("a", "b"),
)


def random_trajectory(seed, points=5, joints=3):
    rng = np.random.default_rng(seed)
    rows = rng.uniform(-1.0, 1.0, (3, points, joints)) * np.array([1.0, 2.0, 9.0])[:, None, None]
    times = np.concatenate(([0.0], np.cumsum(rng.uniform(0.05, 1.0, points - 1))))
    return TimedTrajectory(tuple(f"j{n}" for n in range(joints)), times, *rows)


def controlled(trajectory, times):
    motions = np.full((len(trajectory.times_s), 4, len(trajectory.joints)), np.nan)
    rows = (trajectory.positions, trajectory.velocities, trajectory.accelerations)
    motions[:, :3] = np.stack(rows, axis=1)
    spline = Spline(trajectory.times_s, motions)
    return np.array([spline.sample(time)[:3] for time in times])


def test_it_is_what_the_trajectory_controller_drives():
    trajectory = random_trajectory(1)
    times = np.linspace(0.0, trajectory.duration_s - 1e-6, 400)
    found = np.stack(DrivenSpline.of(trajectory).sample(times), axis=1)
    assert found == pytest.approx(controlled(trajectory, times), abs=1e-8)


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_the_largest_value_of_a_segment_is_bounded_tightly(seed):
    trajectory = random_trajectory(seed, points=2)
    spline = DrivenSpline.of(trajectory)
    samples = spline.sample(np.linspace(0.0, trajectory.duration_s, 2001))
    for order in (1, 2):
        found = np.abs(samples[order]).max(axis=0)
        bound = spline.largest(order)[0]
        assert (bound >= found - 1e-9).all()
        assert (bound <= 1.2 * found + 0.05).all()


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_no_state_is_farther_from_its_chord_than_the_deviation(seed):
    trajectory = random_trajectory(seed, points=2)
    states = DrivenSpline.of(trajectory).sample(np.linspace(0.0, trajectory.duration_s, 300))[0]
    first, last = trajectory.positions
    chord = first + np.linspace(0.0, 1.0, 2001)[:, None] * (last - first)
    deviation = chord_deviation(trajectory)[0]
    away = np.abs(states[:, None] - chord[None]) - deviation
    # Some state of the chord is near in all joints at once.
    assert (away.max(axis=2).min(axis=1) <= 2e-3).all()


def test_a_straight_motion_has_no_deviation_however_its_speed_changes():
    limits = [PlanningLimits(-3.0, 3.0, 1.0, 1.0)] * 2
    trajectory = parameterize([[0.0, 0.0], [1.0, -2.0]], limits, joints=("a", "b"))
    assert chord_deviation(trajectory).max() < 1e-12


def test_a_curve_that_leaves_the_ends_of_its_chord_deviates_by_as_much():
    rest = np.zeros((2, 1))
    swing = TimedTrajectory(
        ("a",), np.array([0.0, 1.0]), np.array([[0.0], [0.1]]), np.array([[-1.0], [0.0]]), rest
    )
    low = DrivenSpline.of(swing).sample(np.linspace(0.0, 1.0, 1000))[0].min()
    assert -low <= chord_deviation(swing)[0, 0] <= -1.2 * low


@pytest.mark.parametrize(
    ("limit", "sentence"),
    [
        (PlanningLimits(-9.0, 9.0, 1.0, 9.0), r"joint 'a' has a velocity of 1\.\d+ rad or m/s"),
        (PlanningLimits(-9.0, 9.0, 9.0, 5.0), r"joint 'a' has an acceleration of"),
        (PlanningLimits(-9.0, 0.5, 9.0, 9.0), r"joint 'a' has a position of 1 rad or m about"),
        (PlanningLimits(-9.0, 9.0, 9.0, 9.0), ""),
    ],
)
def test_a_broken_limit_is_named(limit, sentence):
    rest = np.zeros((2, 1))
    motion = TimedTrajectory(("a",), np.array([0.0, 1.0]), np.array([[0.0], [1.0]]), rest, rest)
    found = limit_violation(motion, [limit])
    assert re.match(sentence, found)
    assert bool(found) is bool(sentence)


def test_one_point_breaks_no_limit_of_motion():
    still = TimedTrajectory(
        ("a",), np.zeros(1), np.ones((1, 1)), np.zeros((1, 1)), np.zeros((1, 1))
    )
    assert limit_violation(still, [PlanningLimits(-2.0, 2.0, 1.0, 1.0)]) == ""


@pytest.mark.parametrize("time_s", [0.37, float(WHOLE.times_s[5])])
def test_the_curve_ahead_stays_the_same(time_s):
    ahead = remaining(WHOLE, time_s)
    assert ahead.duration_s == pytest.approx(WHOLE.duration_s - time_s)
    assert (np.diff(ahead.times_s) > 0.0).all()
    times = np.linspace(0.0, ahead.duration_s, 200)
    found = DrivenSpline.of(ahead).sample(times)
    expected = DrivenSpline.of(WHOLE).sample(times + time_s)
    assert found[0] == pytest.approx(expected[0], abs=1e-9)
    assert found[1] == pytest.approx(expected[1], abs=1e-6)


def test_a_point_just_ahead_is_left_out():
    ahead = remaining(WHOLE, float(WHOLE.times_s[5]) - 1e-10)
    assert np.diff(ahead.times_s).min() > 1e-4


def test_before_the_start_everything_is_ahead():
    assert remaining(WHOLE, -1.0) is WHOLE


def test_after_the_end_the_last_point_is_left():
    ahead = remaining(WHOLE, 99.0)
    assert ahead.positions == pytest.approx(WHOLE.positions[-1:])
    assert ahead.duration_s == 0.0
