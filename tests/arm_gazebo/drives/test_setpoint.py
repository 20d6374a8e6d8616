import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_gazebo.drives.setpoint import Setpoint

PERIOD_S = 0.01


def travel(setpoint, target, speed=2.0, acceleration=50.0, braking=10.0, ticks=1000):
    """Approach a fixed target; return the positions and velocities after every period."""
    positions, velocities = [], []
    for _ in range(ticks):
        setpoint.approach(target, 0.0, speed, acceleration, braking, PERIOD_S)
        positions.append(setpoint.position)
        velocities.append(setpoint.velocity)
    return positions, velocities


@given(
    way=st.floats(-3, 3),
    speed=st.floats(0.05, 5),
    braking=st.floats(0.5, 500),
    extra=st.floats(1, 20),
)
def test_standing_target_is_reached_and_never_passed(way, speed, braking, extra):
    setpoint = Setpoint(0.0)
    acceleration = braking * extra
    ticks = int((abs(way) / speed + speed / braking + 0.1) / PERIOD_S) + 200
    positions, velocities = travel(setpoint, way, speed, acceleration, braking, ticks)
    assert setpoint.position == way
    assert setpoint.velocity == 0.0
    assert all(abs(position) <= abs(way) + 1e-9 for position in positions)
    assert all(abs(velocity) <= speed * (1 + 1e-9) for velocity in velocities)


def test_speed_is_gained_by_acceleration_and_lost_by_braking():
    _, velocities = travel(Setpoint(0.0), 1.0, speed=1.0, acceleration=20.0, braking=5.0)
    gains = [b - a for a, b in zip([0.0, *velocities], velocities, strict=False)]
    assert max(gains) == pytest.approx(20.0 * PERIOD_S)
    assert min(gains) >= -5.0 * PERIOD_S * 1.3


def test_it_brakes_before_it_reverses():
    setpoint = Setpoint(0.0, velocity=1.0)
    positions, _ = travel(setpoint, 0.0, acceleration=10.0, braking=10.0)
    assert max(positions) == pytest.approx(0.05, abs=0.01)
    assert setpoint.position == 0.0


def test_endless_target_is_approached_at_full_speed():
    setpoint = Setpoint(0.0)
    travel(setpoint, math.inf, speed=1.5, ticks=100)
    assert setpoint.velocity == 1.5


def test_speed_of_zero_is_a_stop():
    setpoint = Setpoint(0.0, velocity=1.0)
    travel(setpoint, math.inf, speed=0.0, ticks=100)
    assert setpoint.velocity == 0.0


def test_moving_target_that_can_be_followed_is_hit_in_every_period():
    setpoint = Setpoint(0.0)
    for tick in range(1, 200):
        target = 0.2 * (1 - math.cos(tick * PERIOD_S * 2))
        velocity = 0.4 * math.sin(tick * PERIOD_S * 2)
        setpoint.approach(target, velocity, 2.0, 50.0, 10.0, PERIOD_S)
        assert setpoint.position == target


def test_moving_target_that_is_too_far_is_caught_up_with():
    setpoint = Setpoint(-0.5)
    for tick in range(1, 300):
        setpoint.approach(tick * PERIOD_S, 1.0, 2.0, 50.0, 10.0, PERIOD_S)
    assert setpoint.position == pytest.approx(299 * PERIOD_S)
    assert setpoint.velocity == pytest.approx(1.0)


def test_target_faster_than_the_limit_is_followed_at_the_limit():
    setpoint = Setpoint(0.0)
    for tick in range(1, 200):
        setpoint.approach(5.0 * tick * PERIOD_S, 5.0, 2.0, 50.0, 10.0, PERIOD_S)
    assert setpoint.velocity == pytest.approx(2.0)


def test_stopping_point_is_where_braking_ends():
    setpoint = Setpoint(1.0, velocity=-2.0)
    assert setpoint.stopping_point(10.0) == pytest.approx(0.8)
