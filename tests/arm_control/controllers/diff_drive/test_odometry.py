"""Arcs in the plane, and adding them up."""

from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.controllers.diff_drive.odometry import (
    Odometry,
    PlanarPose,
    PlanarTwist,
    WheelGeometry,
)

angles = st.floats(-20.0, 20.0)
ways = st.floats(-10.0, 10.0)
poses = st.builds(PlanarPose, ways, ways, angles)
GEOMETRY = WheelGeometry(separation=0.3, left_radius=0.05, right_radius=0.06)


def coordinates(pose: PlanarPose) -> list[float]:
    return [pose.x, pose.y, pose.heading]


@given(poses, ways, angles)
def test_an_arc_is_the_circle_s(start, distance, turn):
    end = start.moved(distance, turn)
    if abs(turn) < 1e-3:
        # The circle's own formula divides by the turn; the middle of the way says the same here.
        middle = start.heading + turn / 2
        expected = [start.x + distance * cos(middle), start.y + distance * sin(middle)]
        tolerance = 1e-5
    else:
        radius = distance / turn
        expected = [
            start.x + radius * (sin(start.heading + turn) - sin(start.heading)),
            start.y - radius * (cos(start.heading + turn) - cos(start.heading)),
        ]
        tolerance = 1e-9
    assert coordinates(end) == pytest.approx([*expected, start.heading + turn], abs=tolerance)


@given(poses, ways, angles, st.integers(2, 20))
def test_an_arc_in_pieces_ends_at_the_same_place(start, distance, turn, count):
    pose = start
    for _ in range(count):
        pose = pose.moved(distance / count, turn / count)
    assert coordinates(pose) == pytest.approx(coordinates(start.moved(distance, turn)), abs=1e-9)


@given(poses, ways, angles)
def test_the_return_path_is_the_arc_driven_backwards(start, distance, turn):
    returned = start.moved(distance, turn).moved(-distance, -turn)
    assert coordinates(returned) == pytest.approx(coordinates(start), abs=1e-9)


@given(ways, st.floats(1e-9, 1e-5))
def test_a_tiny_turn_causes_no_division_by_zero(distance, turn):
    bent, straight = PlanarPose().moved(distance, turn), PlanarPose().moved(distance, 0.0)
    assert hypot(bent.x - straight.x, bent.y - straight.y) <= abs(distance) * turn


def test_a_full_circle_ends_where_it_began():
    assert coordinates(PlanarPose().moved(5.0, 2 * pi)) == pytest.approx([0, 0, 2 * pi], abs=1e-12)


@given(st.floats(-3, 3), st.floats(-5, 5))
def test_the_wheels_speeds_are_those_of_the_robot(linear, angular):
    wheels = GEOMETRY.wheel_speeds(PlanarTwist(linear, angular))
    assert GEOMETRY.motion(*wheels) == pytest.approx((linear, angular), abs=1e-12)


def test_equal_distances_of_both_sides_are_straight_on():
    assert GEOMETRY.motion(left=6.0, right=5.0) == pytest.approx((0.3, 0.0))


def test_turning_left_turns_the_right_wheel_forwards():
    left, right = GEOMETRY.wheel_speeds(PlanarTwist(0.0, 1.0))
    assert left < 0 < right


def test_odometry_smooths_the_speeds_over_its_window_and_not_the_pose():
    odometry = Odometry(window=4)
    for distance in (0.0, 0.0, 0.01, 0.01, 0.01, 0.01):
        odometry.move(distance, 0.0, 0.01)
    assert odometry.twist.linear == pytest.approx(1.0)
    odometry.move(0.03, 0.02, 0.01)
    assert odometry.twist.linear == pytest.approx(1.5)
    assert odometry.twist.angular == pytest.approx(0.5)
    assert odometry.pose.x == pytest.approx(0.07, abs=1e-5)


def test_a_halt_forgets_the_speeds_and_keeps_the_pose():
    odometry = Odometry()
    odometry.move(0.5, 0.0, 0.1)
    odometry.halt()
    assert odometry.twist == PlanarTwist(0.0, 0.0)
    assert odometry.pose.x == 0.5
    odometry.move(0.0, 0.0, 0.1)
    assert odometry.twist.linear == 0.0


def test_a_circle_in_cycles_of_a_hundredth_second_closes():
    odometry = Odometry()
    count = 628
    for _ in range(count):
        odometry.move(
            *GEOMETRY.motion(
                *np.array(GEOMETRY.wheel_speeds(PlanarTwist(0.2, 1.0))) * (2 * pi / count)
            ),
            0.01,
        )
    assert coordinates(odometry.pose) == pytest.approx([0.0, 0.0, 2 * pi], abs=1e-9)
