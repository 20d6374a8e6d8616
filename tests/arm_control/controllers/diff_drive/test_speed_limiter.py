"""Bounds of a speed, of its rate and of the rate's rate."""

from itertools import pairwise
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.controllers.diff_drive.parameters import SpeedLimiter, SpeedLimits
from arm_control.errors import ParameterError

PERIOD_S = 0.01
speeds = st.lists(st.floats(-5, 5), min_size=1, max_size=60)
bounds = st.floats(0.05, 10)


def follow(limits: SpeedLimits, wanted: list[float]) -> list[float]:
    limiter = SpeedLimiter(limits)
    return [limiter.limit(speed, PERIOD_S) for speed in wanted]


@given(speeds)
def test_without_bounds_every_speed_is_let_through(wanted):
    assert follow(SpeedLimits(), wanted) == pytest.approx(wanted, abs=1e-12)


@given(speeds, bounds, bounds)
def test_a_speed_stays_within_its_bounds(wanted, upper, lower):
    limited = follow(SpeedLimits(max_velocity=upper, min_velocity=-lower), wanted)
    assert limited == pytest.approx([min(max(w, -lower), upper) for w in wanted], abs=1e-12)


def test_without_a_lower_bound_it_is_the_upper_one_s_mirror_image():
    assert follow(SpeedLimits(max_velocity=0.5), [-2.0]) == [-0.5]


def test_a_lower_bound_works_without_an_upper_one():
    assert follow(SpeedLimits(min_velocity=-0.5), [-2.0, 7.0]) == [-0.5, 7.0]


@given(speeds, bounds, bounds, bounds, bounds)
def test_no_change_is_faster_than_its_bound(wanted, faster, braking, back, braking_back):
    limits = SpeedLimits(
        max_acceleration=faster,
        max_deceleration=-braking,
        max_acceleration_reverse=-back,
        max_deceleration_reverse=braking_back,
    )
    last = 0.0
    for speed in follow(limits, wanted):
        high = braking_back if last < 0 else faster
        low = -braking if last > 0 else -back
        assert low * PERIOD_S - 1e-9 <= speed - last <= high * PERIOD_S + 1e-9
        last = speed


@pytest.mark.parametrize(
    ("switch", "limits"),
    [
        ("has_velocity_limits", {"max_velocity": 0.5, "min_velocity": -0.25}),
        (
            "has_acceleration_limits",
            {
                "max_acceleration": 1.0,
                "max_deceleration": -1.0,
                "max_acceleration_reverse": -1.0,
                "max_deceleration_reverse": 1.0,
            },
        ),
        ("has_jerk_limits", {"max_jerk": 1.0, "min_jerk": -1.0}),
    ],
)
def test_a_deprecated_parameter_lifts_its_bounds_and_is_named(switch, limits):
    wanted = [2.0, -2.0, 0.5]
    assert follow(SpeedLimits(**limits), wanted) != wanted
    lifted = SpeedLimits(**limits, **{switch: False})
    assert follow(lifted, wanted) == pytest.approx(wanted)
    (sentence,) = lifted.deprecations("linear.x.")
    assert sentence.startswith(f"parameter 'linear.x.{switch}' is deprecated")
    assert all(bound in sentence for bound in limits)


def test_min_acceleration_has_no_effect_as_in_jazzy_and_says_what_has():
    limits = SpeedLimits(min_acceleration=-1.0)
    assert follow(limits, [2.0, -2.0]) == [2.0, -2.0]
    (sentence,) = limits.deprecations("angular.z.")
    assert "'angular.z.min_acceleration' is deprecated and has no effect" in sentence
    assert "'angular.z.max_deceleration'" in sentence


@given(speeds, bounds)
def test_one_acceleration_limit_applies_to_all_four(wanted, acceleration):
    every = SpeedLimits(nan, nan, acceleration, -acceleration, -acceleration, acceleration)
    assert follow(SpeedLimits(max_acceleration=acceleration), wanted) == follow(every, wanted)


@given(st.floats(-2, 2), st.floats(1, 10), st.floats(5, 100))
def test_with_every_bound_the_wanted_speed_is_reached_and_kept(wanted, acceleration, jerk):
    limits = SpeedLimits(max_velocity=2.0, max_acceleration=acceleration, max_jerk=jerk)
    assert follow(limits, [wanted] * 1000)[-3:] == pytest.approx([wanted] * 3, abs=1e-9)


def test_the_rate_grows_no_faster_than_the_jerk():
    speeds = [0.0, *follow(SpeedLimits(max_jerk=2.0), [1.0] * 20)]
    rates = [(b - a) / PERIOD_S for a, b in pairwise(speeds)]
    grown = [b - a for a, b in pairwise([0.0, *rates])]
    assert max(grown) == pytest.approx(2.0 * PERIOD_S)
    assert min(grown) == pytest.approx(2.0 * PERIOD_S)


def test_it_can_begin_at_a_speed():
    limiter = SpeedLimiter(SpeedLimits(max_acceleration=1.0), 0.8)
    assert limiter.limit(0.0, PERIOD_S) == pytest.approx(0.79)


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("max_velocity", -1.0, r"'linear\.x\.max_velocity' is -1, but is an upper bound"),
        ("min_velocity", 1.0, r"'linear\.x\.min_velocity' is 1, but is a lower bound"),
        ("max_deceleration", 1.0, "is a lower bound"),
        ("max_acceleration_reverse", 1.0, "is a lower bound"),
        ("max_deceleration_reverse", -1.0, "is an upper bound"),
        ("max_jerk", 0.0, r"is 0, so the robot could never change its speed; \.nan"),
        ("max_acceleration", 0.0, "could never change"),
    ],
)
def test_a_bound_that_makes_no_sense_is_refused(name, value, sentence):
    with pytest.raises(ParameterError, match=sentence):
        SpeedLimits(**{name: value}).check("linear.x.")


@pytest.mark.parametrize("limits", [SpeedLimits(), SpeedLimits(max_velocity=inf, max_jerk=inf)])
def test_missing_or_infinite_bounds_limit_nothing(limits):
    limits.check("linear.x.")
    assert follow(limits, [1000.0, -1000.0]) == [1000.0, -1000.0]
