"""Properties of every trajectory."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arm_control.controllers.angles import nearest_turn, shortest_angular_distance
from arm_control.controllers.joint_trajectory.profiles import (
    LARGEST,
    RESOLUTION_S,
    JoinedProfile,
    Spline,
    SplineProfile,
    StopProfile,
)
from arm_control.controllers.joint_trajectory.trajectory import integrate

JOINTS = 2
STEP_S = 1e-8
NOT_CONTINUOUS = np.zeros(JOINTS, dtype=np.bool_)

unhurried = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
"""On a busy machine an example may take its time."""

numbers = st.floats(-10.0, 10.0)
degrees = st.sampled_from([1, 3, 5])
KNOWN_ROWS = {1: 1, 3: 2, 5: 3}


@st.composite
def motions(draw: Callable, degree: int | None = None) -> np.ndarray:
    """A motion with the rows that the polynomial's degree needs."""
    known = KNOWN_ROWS[draw(degrees) if degree is None else degree]
    motion = np.full((4, JOINTS), np.nan)
    motion[:known] = [[draw(numbers) for _ in range(JOINTS)] for _ in range(known)]
    return motion


@st.composite
def way_points(draw: Callable, degree: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Times and motions; of one degree, or of any mixture."""
    gaps = draw(st.lists(st.floats(0.1, 5.0), min_size=1, max_size=6))
    points = [draw(motions(degree)) for _ in gaps]
    return np.cumsum(gaps), np.stack(points)


@st.composite
def profiles(draw: Callable, degree: int | None = None) -> SplineProfile:
    """A profile from a start whose rates may be unknown; it begins in the past or the future."""
    times, points = draw(way_points(degree))
    offset = draw(st.floats(-times[-1], 5.0))
    return SplineProfile(
        draw(motions()), points[0], Spline(times, points), float(times[0]), offset_s=offset
    )


def around(function: Callable, time_s: float) -> tuple[np.ndarray, np.ndarray]:
    return function(time_s - STEP_S), function(time_s + STEP_S)


@unhurried
@given(way_points())
def test_every_waypoint_is_reached_exactly(points):
    times, motions_there = points
    spline = Spline(times, motions_there)

    for time_s, motion in zip(times, motions_there, strict=True):
        assert spline.sample(time_s)[0].tolist() == motion[0].tolist()


@pytest.mark.parametrize(("degree", "continuous_rows"), [(1, 1), (3, 2), (5, 3)])
def test_continuity_at_waypoints(degree, continuous_rows):
    @unhurried
    @given(way_points(degree))
    def check(points: tuple[np.ndarray, np.ndarray]) -> None:
        times, motions_there = points
        spline = Spline(times, motions_there)
        for time_s, motion in zip(times[1:-1], motions_there[1:-1], strict=True):
            for side in around(spline.sample, time_s):
                rows = slice(0, continuous_rows)
                assert np.allclose(side[rows], motion[rows], rtol=0.0, atol=0.1)

    check()


@unhurried
@given(profiles())
def test_the_end_lasts(profile):
    end = profile.sample(max(profile.end_s, 0.0))

    assert profile.sample(max(profile.end_s, 0.0) + 7.0).tolist() == end.tolist()


@unhurried
@given(profiles(), st.lists(st.floats(0.0, 30.0), min_size=1, max_size=8))
def test_a_sample_does_not_depend_on_the_samples_before(profile, times):
    """Upstream keeps a cursor in the trajectory; here a sample is a function of time alone."""
    alone = [profile.sample(time_s).tolist() for time_s in times]
    backwards = [profile.sample(time_s).tolist() for time_s in reversed(times)]

    assert alone == backwards[::-1]


@unhurried
@given(profiles(), st.floats(0.0, 30.0))
def test_nothing_is_left_open(profile, time_s):
    assert np.isfinite(profile.sample(time_s)).all()


@unhurried
@given(
    st.lists(
        st.lists(st.floats(-LARGEST, LARGEST), min_size=6, max_size=6), min_size=2, max_size=4
    ),
    st.sampled_from([RESOLUTION_S, 1e-3, 1.0, 2.0**31]),
    st.floats(0.0, 1.0),
)
def test_no_number_that_is_taken_overflows(points, gap_s, fraction):
    motions_there = np.full((len(points), 4, JOINTS), np.nan)
    motions_there[:, :3] = np.reshape(points, (-1, 3, JOINTS))
    times = np.array([gap_s * (1 + i) for i in range(len(points))])
    first = float(times[0])
    profile = SplineProfile(
        -motions_there[0], motions_there[0], Spline(times, motions_there), first, 0.0
    )

    assert np.isfinite(profile.sample(fraction * float(times[-1]))).all()


@unhurried
@given(way_points(), st.floats(0.0, 1.0))
def test_velocity_and_acceleration_are_derivatives(points, fraction):
    times, motions_there = points
    spline = Spline(times, motions_there)
    for begin, end in pairwise(times):
        time_s = begin + 1e-3 + fraction * (end - begin - 2e-3)
        before, after = spline.sample(time_s - 1e-5), spline.sample(time_s + 1e-5)
        here = spline.sample(time_s)
        slope = (after[:2] - before[:2]) / 2e-5
        assert np.allclose(here[1:3], slope, rtol=1e-3, atol=1e-3 * (1.0 + np.abs(here).max()))


@unhurried
@given(st.lists(st.floats(0.05, 5.0), min_size=1, max_size=5), st.data())
def test_integrated_velocities_are_followed(gaps, data):
    times = np.cumsum(gaps)
    points = np.full((len(times), 4, JOINTS), np.nan)
    points[:, 1] = [[data.draw(numbers) for _ in range(JOINTS)] for _ in times]
    start = np.zeros((4, JOINTS))

    spline = Spline(times, integrate(times, points, start))

    halfway = (times[:-1] + times[1:]) / 2.0
    for i, time_s in enumerate(halfway):
        mean = (points[i, 1] + points[i + 1, 1]) / 2.0
        assert np.allclose(spline.sample(time_s)[1], mean, atol=1e-8)


@unhurried
@given(numbers, numbers)
def test_the_shortest_rotation_is_short_and_arrives(start, end):
    way = shortest_angular_distance(np.array([start]), np.array([end]))[0]

    assert abs(way) <= np.pi + 1e-9
    assert np.cos(start + way) == pytest.approx(np.cos(end), abs=1e-9)
    assert np.sin(start + way) == pytest.approx(np.sin(end), abs=1e-9)


@unhurried
@given(numbers, numbers)
def test_the_nearest_turn_is_the_same_angle(start, end):
    moved = nearest_turn(np.array([start]), np.array([end]), np.array([True]))[0]

    assert abs(end - moved) <= np.pi + 1e-9
    assert np.cos(moved) == pytest.approx(np.cos(start), abs=1e-9)


@unhurried
@given(way_points(), motions(degree=5), st.floats(-10.0, 5.0), st.floats(0.01, 3.0))
def test_a_join_starts_as_commanded_and_ends_as_planned(points, commanded, offset_s, least_s):
    times, motions_there = points
    commanded = np.nan_to_num(commanded)
    spline, first_s = Spline(times, motions_there), float(times[0])
    profile = JoinedProfile(commanded, spline, first_s, offset_s, least_s, NOT_CONTINUOUS)

    assert np.allclose(profile.sample(0.0)[:3], commanded[:3], atol=1e-9)
    for time_s in (profile.end_s, profile.end_s + 1.0):
        if time_s >= 0.0:
            assert profile.sample(time_s).tolist() == spline.sample(time_s - offset_s).tolist()


@unhurried
@given(
    st.lists(numbers, min_size=JOINTS, max_size=JOINTS),
    st.lists(numbers, min_size=JOINTS, max_size=JOINTS),
    st.lists(st.floats(0.1, 10.0), min_size=JOINTS, max_size=JOINTS),
    st.floats(0.0, 200.0),
)
def test_a_stop_never_turns_back(position, velocity, deceleration, time_s):
    profile = StopProfile(np.array(position), np.array(velocity), np.array(deceleration))
    motion = profile.sample(time_s)
    distance = np.array(velocity) ** 2 / (2.0 * np.array(deceleration))

    assert (motion[1] * np.array(velocity) >= -1e-12).all()
    assert (np.abs(motion[0] - position) <= distance + 1e-9).all()
