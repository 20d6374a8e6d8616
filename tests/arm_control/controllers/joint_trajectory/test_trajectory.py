"""The cases of upstream's test_trajectory.cpp: one joint, sampled before, at and after points."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.profiles import MotionProfile
from arm_control.controllers.joint_trajectory.trajectory import Interpolation, Trajectory

NOW_S = 100.0
EPS = 1e-8


@pytest.fixture
def make_profile(make_request) -> Callable[..., MotionProfile]:
    """Make the profile of one joint from points, starting at [position, velocity, acceleration]."""

    def make(
        points: list[tuple[Any, ...]],
        start: tuple[float, ...] = (0.0,),
        *,
        stamp_s: float = 0.0,
        interpolation: Interpolation = Interpolation.SPLINES,
    ) -> MotionProfile:
        trajectory = Trajectory(make_request(points, ["j"], stamp_s), ["j"], interpolation)
        motion = np.array([*start, *[np.nan] * (4 - len(start))])[:, None]
        return trajectory.profile(NOW_S, motion, np.zeros(1), np.array([False]))

    return make


def rows(profile: MotionProfile, time_s: float) -> list[float]:
    return profile.sample(time_s)[:3, 0].tolist()


def test_sample_trajectory_positions(make_profile):
    profile = make_profile([(1.0, [1.0]), (2.0, [2.0]), (3.0, [3.0])])

    assert rows(profile, 0.0) == pytest.approx([0.0, 1.0, 0.0], abs=EPS)
    assert rows(profile, 0.5) == pytest.approx([0.5, 1.0, 0.0], abs=EPS)
    assert rows(profile, 1.0) == pytest.approx([1.0, 1.0, 0.0], abs=EPS)
    assert rows(profile, 1.5)[0] == pytest.approx(1.5, abs=EPS)
    assert rows(profile, 2.5)[0] == pytest.approx(2.5, abs=EPS)
    assert rows(profile, 3.0)[0] == pytest.approx(3.0, abs=EPS)
    assert rows(profile, 3.125) == [3.0, 0.0, 0.0]


@pytest.mark.parametrize("start", [(0.0, 0.0), (0.0,)], ids=["velocity known", "strange"])
def test_sample_trajectory_velocity_with_interpolation(make_profile, start):
    profile = make_profile([(1.0, [], [1.0]), (2.0, [], [2.0]), (3.0, [], [1.0])], start)

    assert rows(profile, 0.0) == pytest.approx([0.0, 0.0, 1.0], abs=EPS)
    assert rows(profile, 0.5) == pytest.approx([0.125, 0.5, 1.0], abs=EPS)
    assert rows(profile, 1.0) == pytest.approx([0.5, 1.0, 1.0], abs=EPS)
    assert rows(profile, 1.5) == pytest.approx([1.125, 1.5, 1.0], abs=EPS)
    assert rows(profile, 2.0) == pytest.approx([2.0, 2.0, -1.0], abs=EPS)
    assert rows(profile, 2.5) == pytest.approx([2.875, 1.5, -1.0], abs=EPS)
    assert rows(profile, 3.0) == pytest.approx([3.5, 1.0, 0.0], abs=EPS)
    assert rows(profile, 3.125) == pytest.approx([3.5, 1.0, 0.0], abs=EPS)


def test_sample_trajectory_acceleration_with_interpolation(make_profile):
    profile = make_profile(
        [(1.0, [], [], [1.0]), (2.0, [], [], [2.0]), (3.0, [], [], [1.0])], (0.0, 0.0)
    )

    assert rows(profile, 0.0) == pytest.approx([0.0, 0.0, 0.0], abs=EPS)
    assert rows(profile, 1.0) == pytest.approx([0.25, 0.5, 1.0], abs=EPS)
    assert rows(profile, 2.0) == pytest.approx([1.5, 2.0, 2.0], abs=EPS)
    assert rows(profile, 3.0) == pytest.approx([4.25, 3.5, 1.0], abs=EPS)
    assert rows(profile, 3.125) == pytest.approx([4.25, 3.5, 1.0], abs=EPS)


def test_fill_point_before_with_same_degree_as_traj(make_profile):
    profile = make_profile([(1.0, [1.0], [0.0], [0.0]), (2.0, [2.0], [0.0], [0.0])])

    assert rows(profile, 0.0) == pytest.approx([0.0, 0.0, 0.0], abs=EPS)
    # A quintic between two rests is here; a cubic would be at 0.15625.
    assert rows(profile, 0.25)[0] == pytest.approx(0.103515625, abs=EPS)


def test_skip_interpolation(make_profile):
    points = [(1.0, [1.0]), (2.0, [2.0]), (3.0, [3.0])]
    profile = make_profile(points, interpolation=Interpolation.NONE)

    sampled = [rows(profile, t)[0] for t in (0.0, 0.5, 1.0, 1.5, 2.5, 3.0, 3.125)]
    assert sampled == [0.0, 0.0, 2.0, 2.0, 3.0, 3.0, 3.0]


def test_a_trajectory_can_be_planned_again(make_request):
    trajectory = Trajectory(make_request([(1.0, [1.0]), (2.0, [2.0])], ["j"]), ["j"])
    start = np.array([[0.0], [np.nan], [np.nan], [np.nan]])

    first = trajectory.profile(NOW_S, start, np.zeros(1), np.array([False]))
    first.sample(2.5)
    second = trajectory.profile(NOW_S + 5.0, start, np.zeros(1), np.array([False]))

    assert rows(second, 0.0) == [0.0, 1.0, 0.0]
    assert rows(second, 1.5)[0] == 1.5


def test_sample_velocity_only_skipped_last_segment_deduces_positions(make_profile):
    profile = make_profile([(1.0, [0.0], [1.0]), (2.0, [], [1.0]), (2.001, [], [1.0])])

    assert rows(profile, 3.0) == pytest.approx([1.001, 1.0, 0.0], abs=EPS)


def test_sample_velocity_only_past_the_end_at_once(make_profile):
    profile = make_profile([(0.001, [], [1.0]), (0.002, [], [1.0])], (0.5,))

    assert rows(profile, 10.0) == pytest.approx([0.5015, 1.0, 0.0], abs=EPS)


def test_velocities_are_integrated_from_the_given_position_before(make_profile):
    profile = make_profile([(1.0, [5.0]), (2.0, [], [2.0]), (3.0, [9.0]), (4.0, [], [2.0])])

    assert [rows(profile, t)[0] for t in (1.0, 2.0, 3.0, 4.0)] == pytest.approx(
        [5.0, 6.0, 9.0, 10.0]
    )


def test_a_stamp_in_the_future_postpones_the_points(make_profile):
    profile = make_profile([(1.0, [1.0]), (2.0, [2.0])], stamp_s=NOW_S + 3.0)

    assert rows(profile, 2.0)[0] == pytest.approx(0.5)
    assert profile.end_s == pytest.approx(5.0)


def test_velocities_stamped_in_the_past_are_integrated_from_the_first_point(make_profile):
    profile = make_profile([(1.0, [], [2.0]), (3.0, [], [2.0])], (1.0,), stamp_s=NOW_S - 2.0)

    assert rows(profile, 0.0)[0] == pytest.approx(3.0)
    assert rows(profile, 1.0)[0] == pytest.approx(5.0)


def test_joints_come_in_any_order(make_request):
    request = make_request([(1.0, [3.0, 1.0, 2.0])], ["c", "a", "b"])

    assert Trajectory(request, ["a", "b", "c"]).motions[0, 0].tolist() == [1.0, 2.0, 3.0]


def test_joints_not_named_stand_still(make_request):
    request = make_request([(1.0, [3.0], [1.0]), (2.0, [4.0], [0.0])], ["b"])
    start = np.full((4, 2), np.nan)
    start[0] = [0.5, 0.0]

    profile = Trajectory(request, ["a", "b"]).profile(
        NOW_S, start, np.array([0.7, 99.0]), np.array([False, False])
    )

    assert profile.sample(1.0)[:3].T.tolist() == [[0.7, 0.0, 0.0], [3.0, 1.0, pytest.approx(2.0)]]
    assert profile.sample(1.5)[:3, 0].tolist() == [0.7, 0.0, 0.0]


def test_joints_not_named_stand_still_while_others_are_integrated(make_request):
    request = make_request([(1.0, [], [1.0]), (2.0, [], [1.0])], ["b"])
    start = np.full((4, 2), np.nan)
    start[0] = [0.5, 0.0]

    profile = Trajectory(request, ["a", "b"]).profile(
        NOW_S, start, np.array([0.5, 99.0]), np.array([False, False])
    )

    assert profile.sample(2.0)[0] == pytest.approx([0.5, 1.5])


def test_a_continuous_joint_takes_the_shortest_rotation(make_request):
    request = make_request([(1.0, [1.5 * np.pi])], ["j"])
    start = np.array([[0.0], [np.nan], [np.nan], [np.nan]])

    profile = Trajectory(request, ["j"]).profile(NOW_S, start, np.zeros(1), np.array([True]))

    assert profile.sample(0.0)[0, 0] == pytest.approx(2.0 * np.pi)
    assert profile.sample(0.5)[1, 0] == pytest.approx(-0.5 * np.pi)
    assert profile.sample(1.0)[0, 0] == pytest.approx(1.5 * np.pi)
