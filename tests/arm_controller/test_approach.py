"""Whether a pose is reached, and why not."""

import pytest

from arm_controller.pose import AllowedRange, Limits
from arm_controller.publisher_defined_node import Approach

NAMES = ("j0", "j1")
HOME = {"j0": 0.0, "j1": 0.0}


def limits(velocity: float = 2.0) -> Limits:
    return tuple(AllowedRange(name, -3.0, 3.0, velocity) for name in NAMES)


def approach(allowed: Limits | None = None, start: dict[str, float] | None = None) -> Approach:
    start = HOME if start is None else start
    return Approach(
        (1.0, -0.5), allowed or limits(), start, started_s=10.0, tolerance=0.02, timeout_s=5.0
    )


@pytest.mark.parametrize(
    ("positions", "reached"),
    [
        ({"j1": -0.5, "j0": 1.0}, True),
        ({"j0": 1.015, "j1": -0.485, "grip": 7.0}, True),
        ({"j0": 1.021, "j1": -0.5}, False),
        ({"j0": 1.0}, False),
        ({"j0": 1.0, "j1": float("nan")}, False),
    ],
)
def test_is_reached_when_every_joint_is_within_the_tolerance(positions, reached):
    assert approach().is_reached(positions) is reached


def test_setting_the_clock_back_restarts_the_time():
    way = approach()
    assert way.elapsed_s(14.9) == pytest.approx(4.9)
    assert way.elapsed_s(2.0) == 0.0
    assert way.elapsed_s(7.0) == 5.0


def test_forecasts_the_joint_that_is_too_slow():
    assert approach().forecast() is None
    assert approach(limits(velocity=0.1)).forecast() == (
        "joint 'j0' needs at least 10.0 s at its velocity limit of 0.1 rad/s, "
        "and the timeout is 5 s (parameter timeout)"
    )


def test_a_shortfall_names_the_joint_that_is_farthest_off_and_its_error():
    said = approach().shortfall({"j0": 0.9, "j1": 0.0})
    assert said == (
        "joint 'j1' is at 0.0000, 0.5000 rad from -0.5000 (tolerance 0.02); at its velocity limit "
        "joint 'j0' needs only 0.5 s, so something is in its way or another node commands the arm"
    )


def test_a_shortfall_of_slow_joints_blames_their_limit():
    said = approach(limits(velocity=0.1)).shortfall({"j0": 0.5, "j1": -0.5})
    assert "needs at least 10.0 s" in said
    assert "another node" not in said


def test_a_shortfall_of_an_unknown_robot_makes_no_claim_on_time():
    said = approach(tuple(map(AllowedRange, NAMES))).shortfall(HOME)
    assert said.endswith("; something is in its way or another node commands the arm")


@pytest.mark.parametrize(
    ("positions", "said"),
    [
        ({"a": 0.0, "j0": 1.0}, "no joint 'j1' in /joint_states, which has a, j0"),
        ({}, "/joint_states is silent: is the joint_state_broadcaster active?"),
        (
            {"j0": float("nan"), "j1": -0.5},
            "the position of joint 'j0' in /joint_states is not a number",
        ),
    ],
)
def test_positions_that_are_missing_are_reported(positions, said):
    assert approach(start={}).shortfall(positions) == said
