"""Timed paths, judged by the trajectory controller's own interpolation every millisecond."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_control.controllers.joint_trajectory.profiles import Spline
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.parameterize import parameterize, scaling_factor

CORNER = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]


def limits(velocity=1.0, acceleration=1.0, *, joints=2, jerk=np.inf):
    return [PlanningLimits(-3.0, 3.0, velocity, acceleration, jerk)] * joints


def timed(path, bounds, **options):
    return parameterize(path, bounds, joints=[f"j{n}" for n in range(len(bounds))], **options)


def driven(trajectory):
    """Return positions, velocities and accelerations that the controller commands, (k, 3, n)."""
    rows = (trajectory.positions, trajectory.velocities, trajectory.accelerations)
    motions = np.full((len(trajectory.times_s), 4, len(trajectory.joints)), np.nan)
    motions[:, :3] = np.stack(rows, axis=1)
    spline = Spline(trajectory.times_s, motions)
    return np.array([spline.sample(t)[:3] for t in np.arange(0.0, trajectory.duration_s, 1e-3)])


def largest(trajectory, row):
    return np.abs(driven(trajectory)[:, row]).max(axis=0)


def distance_to(states, point):
    return np.linalg.norm(states - point, axis=1).min()


def test_a_straight_path_takes_as_long_as_a_trapezoid():
    found = timed([[0.0, 0.0], [1.5, -0.5]], limits())
    # 1.5 / v + v / a, and two time steps.
    assert found.duration_s == pytest.approx(2.5, rel=0.006)
    assert found.duration_s >= 2.5


def test_a_short_path_never_reaches_full_speed():
    assert timed([[0.0], [0.25]], limits(joints=1)).duration_s == pytest.approx(1.0, rel=0.006)


def test_it_starts_and_ends_at_rest_in_the_first_and_last_way_point():
    found = timed(CORNER, limits())
    for row, point in ((0, CORNER[0]), (-1, CORNER[-1])):
        assert found.positions[row] == pytest.approx(np.array(point), abs=1e-12)
        assert found.velocities[row] == pytest.approx(np.zeros(2), abs=1e-12)
        assert found.accelerations[row] == pytest.approx(np.zeros(2), abs=1e-9)


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1), st.integers(1, 7), st.integers(2, 8), st.floats(1e-4, 1.0))
def test_limits_hold_every_millisecond(seed, joints, count, tolerance):
    rng = np.random.default_rng(seed)
    path = rng.uniform(-1.0, 1.0, (count, joints)) * 10.0 ** rng.uniform(-2.0, 0.3, joints)
    bounds = [
        PlanningLimits(-9.0, 9.0, 10.0 ** rng.uniform(-0.5, 1.0), 10.0 ** rng.uniform(-0.3, 1.5))
        for _ in range(joints)
    ]
    found = timed(path, bounds, path_tolerance=tolerance)
    assert (largest(found, 1) <= [limit.velocity * 1.001 for limit in bounds]).all()
    assert (largest(found, 2) <= [limit.acceleration * 1.001 for limit in bounds]).all()
    positions = driven(found)[:, 0]
    assert (positions >= path.min(axis=0) - 1e-8).all()
    assert (positions <= path.max(axis=0) + 1e-8).all()


def test_a_limit_is_used_up():
    found = timed(np.random.default_rng(3).uniform(-1.0, 1.0, (6, 3)), limits(joints=3))
    assert max(largest(found, 2)) > 0.99


def test_a_corner_is_rounded_within_the_tolerance():
    found = driven(timed(CORNER, limits(), path_tolerance=0.05))[:, 0]
    assert 0.045 < distance_to(found, CORNER[1]) < 0.0502


def test_a_wider_corner_is_faster():
    durations = [timed(CORNER, limits(), path_tolerance=t).duration_s for t in (0.0, 0.01, 0.1)]
    assert durations == sorted(durations, reverse=True)
    assert durations[0] > durations[2] + 0.3


def test_it_stops_at_a_way_point_without_tolerance():
    found = driven(timed(CORNER, limits(), max_deviation=[0.1, 0.0, 0.1]))
    nearest = np.argmin(np.linalg.norm(found[:, 0] - CORNER[1], axis=1))
    assert found[nearest, 0] == pytest.approx(np.array(CORNER[1]), abs=1e-6)
    assert np.abs(found[nearest, 1]).max() < 2e-3
    # It keeps to both sides of the corner exactly.
    assert (np.minimum(np.abs(found[:, 0, 1]), np.abs(found[:, 0, 0] - 1.0)) < 1e-9).all()


def test_a_straight_way_point_without_tolerance_is_passed_at_speed():
    halves = timed([[0.0], [1.0], [2.0]], limits(joints=1), max_deviation=[0.0, 0.0, 0.0])
    assert halves.duration_s == timed([[0.0], [2.0]], limits(joints=1)).duration_s


def test_it_stops_where_the_path_turns_back():
    found = timed([[0.0], [1.0], [0.5]], limits(joints=1))
    assert driven(found)[:, 0].max() == pytest.approx(1.0, abs=1e-6)


def test_points_are_at_most_the_resampling_time_apart():
    for resample_dt in (0.1, 0.03):
        steps = np.diff(timed(CORNER, limits(), resample_dt=resample_dt).times_s)
        assert steps.max() <= resample_dt + 1e-9
        assert steps.min() > 0.0


def test_times_are_whole_nanoseconds():
    times = timed(CORNER, limits()).times_s
    assert (times == np.round(times * 1e9) / 1e9).all()


def test_scaling_factors_slow_it_down():
    assert largest(timed(CORNER, limits(), velocity_scaling=0.3), 1).max() <= 0.3003
    assert largest(timed(CORNER, limits(), acceleration_scaling=0.3), 2).max() <= 0.3003


@pytest.mark.parametrize("factor", [0.0, -1.0, 1.5, float("nan")])
def test_an_invalid_scaling_factor_counts_as_one(factor, caplog):
    assert scaling_factor(factor, "velocity") == 1.0
    assert "Invalid max_velocity_scaling_factor" in caplog.text


def test_a_jerk_limit_holds_if_asked_for():
    bounds = limits(jerk=5.0)
    hasty, calm = (timed(CORNER, bounds, limit_jerk=asked) for asked in (False, True))
    for found, holds in ((hasty, False), (calm, True)):
        jerk = np.abs(np.diff(driven(found)[:, 2], axis=0)).max() / 1e-3
        assert bool(jerk < 5.01) is holds
    assert calm.duration_s < hasty.duration_s + 0.5


@pytest.mark.parametrize("path", [[[0.5, 0.5]], [[0.5, 0.5]] * 4, [[0.5, 0.5], [0.5, 0.5 + 1e-12]]])
def test_a_path_without_a_way_to_go_is_one_point(path):
    found = timed(path, limits())
    assert found.duration_s == 0.0
    assert found.positions.shape == (1, 2)
    assert not found.velocities.any()


def test_repeated_way_points_change_nothing():
    repeated = [point for point in CORNER for _ in range(3)]
    assert timed(repeated, limits()).duration_s == timed(CORNER, limits()).duration_s


def test_way_points_near_the_one_before_are_dropped_and_the_ends_kept():
    found = timed([[0.0], [1e-4], [1.0], [1.0 + 5e-4]], limits(joints=1))
    assert found.positions[[0, -1], 0] == pytest.approx(np.array([0.0, 1.0005]))
    there_and_back = timed([[0.0], [5e-4]], limits(joints=1))
    assert there_and_back.positions[-1, 0] == pytest.approx(5e-4)


def test_a_joint_that_stays_needs_no_limits():
    bounds = [*limits(joints=1), PlanningLimits(-1.0, 1.0, np.inf, np.inf)]
    assert timed([[0.0, 0.5], [1.0, 0.5]], bounds).duration_s == pytest.approx(2.0, rel=0.006)


@pytest.mark.parametrize(
    ("bounds", "sentence"),
    [
        (limits(np.inf), "No velocity limit was defined for joint j0!"),
        (limits(1.0, np.inf), "No acceleration limit was defined for joint j0!"),
        (limits(0.0), "Invalid max_velocity 0 specified for joint j0"),
        (limits(1.0, np.nan), "Invalid max_acceleration nan specified for joint j0"),
        (limits(1e-9), "the motion would take 2e[+]09 s"),
    ],
)
def test_limits_that_cannot_be_used(bounds, sentence):
    with pytest.raises(PlanningError, match=sentence) as error:
        timed(CORNER, bounds, path_tolerance=0.0)
    assert error.value.code is MoveItErrorCode.FAILURE


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        (np.zeros((0, 2)), "no way points"),
        ([[0.0, 0.0], [0.0, np.nan]], "way point 1 of the path has nan for joint 'j1'"),
        ([[0.0, 0.0], [1e300, 0.0]], "way point 1 of the path has 1e[+]300 for joint 'j0'"),
    ],
)
def test_paths_that_cannot_be_driven(path, sentence):
    with pytest.raises(PlanningError, match=sentence) as error:
        timed(path, limits())
    assert error.value.code is MoveItErrorCode.INVALID_MOTION_PLAN


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"path_tolerance": -0.1}, "path tolerance is -0.1"),
        ({"path_tolerance": np.nan}, "path tolerance is nan"),
        ({"resample_dt": 0.0}, "resample_dt is 0 s"),
        ({"resample_dt": np.nan}, "resample_dt is nan s"),
    ],
)
def test_options_that_make_no_sense(options, sentence):
    with pytest.raises(PlanningError, match=sentence):
        timed(CORNER, limits(), **options)


def test_enormous_limits_keep_to_the_path():
    found = driven(timed(CORNER, limits(1e9, 1e9), path_tolerance=0.0))[:, 0]
    assert (np.minimum(np.abs(found[:, 1]), np.abs(found[:, 0] - 1.0)) < 1e-3).all()
