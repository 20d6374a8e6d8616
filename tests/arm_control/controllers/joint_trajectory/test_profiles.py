"""Profiles from the present motion to waypoints, or to rest."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.profiles import (
    JoinedProfile,
    Spline,
    SplineProfile,
    StepProfile,
    StopProfile,
    at_rest,
)

NAN = np.nan
NOT_CONTINUOUS = np.array([False])


def motion(*rows: float) -> np.ndarray:
    return np.array([*rows, *[NAN] * (4 - len(rows))])[:, None]


def profile_through(
    start: np.ndarray, *points: tuple[float, np.ndarray], offset_s: float = 0.0
) -> SplineProfile:
    times = np.array([time for time, _ in points])
    motions = np.stack([point for _, point in points])
    return SplineProfile(start, motions[0], Spline(times, motions), float(times[0]), offset_s)


class TestSplineProfile:
    def test_leads_in_linearly_to_a_point_of_positions(self):
        profile = profile_through(motion(1.0, 7.0), (2.0, motion(2.0)))

        assert profile.sample(0.0)[:3, 0].tolist() == [1.0, 0.5, 0.0]
        assert profile.sample(1.0)[0, 0] == 1.5

    def test_leads_in_with_the_velocity_of_the_start_where_the_point_has_one(self):
        profile = profile_through(motion(1.0, 7.0), (2.0, motion(2.0, 0.0)))

        assert profile.sample(0.0)[:2, 0].tolist() == [1.0, 7.0]

    def test_values_that_the_start_does_not_give_count_as_zero(self):
        profile = profile_through(
            motion(0.0), (1.0, motion(1.0, 0.0, 0.0)), (2.0, motion(2.0, 0.0, 0.0))
        )

        assert profile.sample(0.0)[:3, 0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
        assert profile.sample(0.5)[:2, 0] == pytest.approx([0.5, 1.875], abs=1e-12)

    def test_a_point_that_is_due_at_once_is_jumped_to(self):
        profile = profile_through(motion(5.0), (0.0, motion(1.0)), (1.0, motion(2.0)))

        assert profile.sample(0.0)[0, 0] == 1.0

    def test_points_in_the_past_are_skipped_without_a_lead_in(self):
        profile = profile_through(
            motion(5.0), (1.0, motion(1.0)), (3.0, motion(3.0)), offset_s=-2.0
        )

        assert profile.sample(0.0)[0, 0] == 2.0
        assert profile.end_s == 1.0

    def test_a_start_in_the_future_is_moved_to_from_now_on(self):
        profile = profile_through(motion(0.0), (1.0, motion(4.0)), (2.0, motion(5.0)), offset_s=3.0)

        assert [profile.sample(t)[0, 0] for t in (0.0, 1.0, 4.0, 4.5)] == [0.0, 1.0, 4.0, 4.5]
        assert profile.end_s == 5.0

    def test_the_lead_in_of_efforts_begins_with_none(self):
        profile = profile_through(motion(0.0), (1.0, motion(0.0, NAN, NAN, 4.0)))

        assert [profile.sample(t)[3, 0] for t in (0.0, 0.5, 1.0)] == [0.0, 2.0, 4.0]


class TestStepProfile:
    profile = StepProfile(
        motion(0.0), np.stack([motion(1.0), motion(2.0), motion(3.0)]), np.array([1.0, 2.0, 3.0])
    )

    def test_holds_the_start_before_the_first_point(self):
        assert [self.profile.sample(t)[0, 0] for t in (0.0, 0.5)] == [0.0, 0.0]

    def test_jumps_to_the_next_point_when_one_is_due(self):
        assert [self.profile.sample(t)[0, 0] for t in (1.0, 1.5, 2.0, 2.5)] == [2.0, 2.0, 3.0, 3.0]

    def test_stays_at_the_last_point(self):
        assert [self.profile.sample(t)[0, 0] for t in (3.0, 3.125)] == [3.0, 3.0]
        assert self.profile.end_s == 3.0

    def test_has_zero_for_what_the_points_leave_open(self):
        assert self.profile.sample(1.0)[1:, 0].tolist() == [0.0, 0.0, 0.0]


class TestStopProfile:
    profile = StopProfile(
        np.array([1.0, 1.0, 1.0]), np.array([2.0, -2.0, 0.0]), np.array([4.0, 1.0, 1.0])
    )

    def test_each_joint_stops_after_its_own_time(self):
        assert self.profile.sample(0.5)[1].tolist() == [0.0, -1.5, 0.0]
        assert self.profile.end_s == 2.0

    def test_each_joint_goes_its_stopping_distance(self):
        assert self.profile.sample(2.0)[0].tolist() == [1.5, -1.0, 1.0]
        assert self.profile.sample(9.0)[0].tolist() == [1.5, -1.0, 1.0]

    def test_begins_with_the_state_it_is_given(self):
        assert self.profile.sample(0.0)[0].tolist() == [1.0, 1.0, 1.0]
        assert self.profile.sample(0.0)[1].tolist() == [2.0, -2.0, 0.0]

    def test_decelerates_constantly(self):
        assert self.profile.sample(0.25)[2].tolist() == [-4.0, 1.0, 0.0]
        assert self.profile.sample(1.0)[2].tolist() == [0.0, 1.0, 0.0]

    def test_hold_stays_where_it_is_at_once(self):
        hold = StopProfile.hold(np.array([0.3]))

        assert hold.end_s == 0.0
        assert hold.sample(0.0)[:, 0].tolist() == [0.3, 0.0, 0.0, 0.0]


class TestJoinedProfile:
    times = np.array([0.0, 4.0])
    spline = Spline(times, np.stack([motion(1.0, 0.5), motion(3.0, 0.5)]))
    commanded = motion(0.2, -1.0, 3.0, 0.0)

    def joined(
        self, *, offset_s: float = 0.0, commanded: np.ndarray | None = None
    ) -> JoinedProfile:
        commanded = self.commanded if commanded is None else commanded
        return JoinedProfile(commanded, self.spline, 0.0, offset_s, 1.0, NOT_CONTINUOUS)

    @pytest.mark.parametrize("offset_s", [-3.5, -1.0, 0.0, 0.001, 0.5, 3.0])
    def test_starts_as_commanded_wherever_the_spline_is(self, offset_s):
        sample = self.joined(offset_s=offset_s).sample(0.0)

        assert sample[:3, 0] == pytest.approx([0.2, -1.0, 3.0])

    def test_is_the_spline_itself_after_the_join(self):
        profile = self.joined()

        assert profile.sample(1.0).tolist() == self.spline.sample(1.0).tolist()
        assert profile.end_s == 4.0

    def test_arrives_at_a_first_point_that_leaves_time_enough(self):
        profile = self.joined(offset_s=2.0)

        assert profile.sample(2.0)[:2, 0] == pytest.approx([1.0, 0.5])
        assert profile.sample(2.5).tolist() == self.spline.sample(0.5).tolist()

    def test_takes_its_time_where_the_first_point_leaves_none(self):
        speeds = [abs(self.joined(offset_s=0.001).sample(t)[1, 0]) for t in np.linspace(0, 1, 101)]

        assert max(speeds) < 4.0

    def test_ends_no_sooner_than_it_is_joined(self):
        profile = self.joined(offset_s=-3.9)

        assert profile.end_s == 1.0
        assert profile.sample(1.0)[:2, 0].tolist() == [3.0, 0.5]

    def test_nothing_to_join_takes_no_time(self):
        profile = self.joined(offset_s=-9.0, commanded=motion(3.0, 0.5, 0.0, 0.0))

        assert profile.end_s == -5.0

    def test_a_continuous_joint_joins_by_the_shortest_rotation(self):
        rest = Spline(np.array([0.0]), motion(6.0)[None])
        profile = JoinedProfile(at_rest(np.array([0.0])), rest, 0.0, 0.0, 1.0, np.array([True]))

        assert profile.sample(0.0)[0, 0] == pytest.approx(2.0 * np.pi)

    @pytest.mark.parametrize("offset_s", [-1.0, 0.0, 0.3, 2.0])
    def test_has_no_step_anywhere(self, offset_s):
        profile = self.joined(offset_s=offset_s)
        times = np.linspace(0.0, 2.2, 22001)
        samples = np.stack([profile.sample(t)[:, 0] for t in times])

        assert np.abs(np.diff(samples[:, 0])).max() < 5e-4
        assert np.abs(np.diff(samples[:, 1])).max() < 5e-3


def spline(*points: tuple[float, list[float]]) -> Spline:
    """Through (time, [position, velocity, acceleration, effort]) of one joint."""
    times = np.array([time for time, _ in points])
    return Spline(times, np.array([motion for _, motion in points])[:, :, None])


def test_linear_segments_have_their_slope_as_velocity_and_no_acceleration():
    motion = spline((1.0, [0.1, NAN, NAN, NAN]), (4.0, [0.7, NAN, NAN, NAN])).sample(2.0)

    assert motion[:3, 0] == pytest.approx([0.3, 0.2, 0.0], abs=1e-15)
    assert motion[2, 0] == 0.0


def test_velocities_at_both_ends_make_a_cubic():
    # x^3 - 2x from 0 to 2; the acceleration at one end alone does not count
    cubic = spline((1.0, [0.0, -2.0, NAN, NAN]), (3.0, [4.0, 10.0, 0.0, NAN]))
    root = np.sqrt(2.0)

    assert cubic.sample(1.0)[:3, 0] == pytest.approx([0.0, -2.0, 0.0], abs=1e-12)
    assert cubic.sample(1.0 + root)[:3, 0] == pytest.approx([0.0, 4.0, 6.0 * root], abs=1e-12)
    assert cubic.sample(3.0 - 2e-9)[:3, 0] == pytest.approx([4.0, 10.0, 12.0], abs=1e-6)


def test_accelerations_at_both_ends_make_a_quintic():
    # x (x-1) (x-2) (x-3) (x-4) from 0 to 2
    quintic = spline((1.0, [0.0, 24.0, -100.0, NAN]), (3.0, [0.0, 4.0, 0.0, NAN]))

    assert quintic.sample(1.0)[:3, 0] == pytest.approx([0.0, 24.0, -100.0], abs=1e-12)
    assert quintic.sample(2.0)[:3, 0] == pytest.approx([0.0, -6.0, 10.0], abs=1e-12)
    assert quintic.sample(3.0)[:3, 0] == pytest.approx([0.0, 4.0, 0.0], abs=1e-12)


def test_velocity_at_one_end_only_makes_it_linear():
    motion = spline((0.0, [0.0, 5.0, NAN, NAN]), (2.0, [2.0, NAN, NAN, NAN])).sample(1.0)

    assert motion[:3, 0] == pytest.approx([1.0, 1.0, 0.0])


def test_acceleration_without_velocity_makes_it_linear():
    motion = spline((0.0, [0.0, NAN, 3.0, NAN]), (2.0, [2.0, NAN, 3.0, NAN])).sample(1.0)

    assert motion[:3, 0] == pytest.approx([1.0, 1.0, 0.0])


def test_effort_is_linear_and_zero_where_it_is_not_given():
    through = spline(
        (0.0, [0.0, 1.0, NAN, NAN]), (2.0, [2.0, 1.0, NAN, 8.0]), (4.0, [3.0, 1.0, NAN, 4.0])
    )

    assert [through.sample(t)[3, 0] for t in (0.5, 2.0, 3.0, 4.0)] == [2.0, 8.0, 6.0, 4.0]


def test_after_the_end_the_last_point_lasts_with_zero_for_what_it_leaves_open():
    through = spline((0.0, [0.0, NAN, NAN, NAN]), (1.0, [2.0, NAN, NAN, NAN]))

    assert through.sample(1.0)[:, 0].tolist() == [2.0, 0.0, 0.0, 0.0]
    assert through.sample(99.0)[:, 0].tolist() == [2.0, 0.0, 0.0, 0.0]


def test_a_velocity_at_the_end_lasts():
    through = spline((0.0, [0.0, 0.0, NAN, NAN]), (1.0, [2.0, 0.5, NAN, NAN]))

    assert through.sample(7.0)[:, 0].tolist() == [2.0, 0.5, 0.0, 0.0]


def test_one_point_alone_is_a_constant():
    assert spline((0.0, [1.5, NAN, NAN, NAN])).sample(3.0)[:, 0].tolist() == [1.5, 0.0, 0.0, 0.0]


def test_a_sum_of_periods_reaches_a_point_in_spite_of_rounding():
    through = spline((0.0, [0.0, NAN, NAN, NAN]), (0.3, [3.0, NAN, NAN, NAN]))

    assert 0.1 + 0.1 + 0.1 != 0.3
    assert through.sample(0.3 - 1e-12)[1, 0] == 0.0, "the end, not the slope before it"


def test_samples_are_the_callers_own():
    through = spline((0.0, [1.0, NAN, NAN, NAN]))
    through.sample(0.0)[:] = 9.0

    assert through.sample(0.0)[0, 0] == 1.0
