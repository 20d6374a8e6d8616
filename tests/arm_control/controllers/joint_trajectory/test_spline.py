"""Polynomials through waypoints."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.profiles import Spline

NAN = np.nan


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
