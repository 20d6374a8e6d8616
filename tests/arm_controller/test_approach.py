"""Whether a pose is reached, and why not."""

import pytest

from arm_controller.approach import Approach
from arm_controller.joint_limits import JointLimits, JointRange, no_limits
from arm_controller.pose import JointPose

NAMES = ("j0", "j1")
GOAL = JointPose(NAMES, (1.0, -0.5))
HOME = {"j0": 0.0, "j1": 0.0}


def limits(velocity: float = 2.0) -> JointLimits:
    return JointLimits(tuple(JointRange(name, -3.0, 3.0, velocity, "rad") for name in NAMES))


def approach(allowed: JointLimits | None = None, start: dict[str, float] | None = None) -> Approach:
    return Approach(
        GOAL,
        allowed or limits(),
        HOME if start is None else start,
        started_s=10.0,
        tolerance=0.02,
        timeout_s=5.0,
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


def test_is_late_after_the_time_out():
    assert not approach().is_late(14.9)
    assert approach().is_late(15.0)


def test_a_clock_that_is_set_back_starts_the_time_anew():
    way = approach()
    assert not way.is_late(2.0)
    assert not way.is_late(6.9)
    assert way.is_late(7.0)


def test_no_forecast_where_the_time_suffices():
    assert approach().forecast() is None


def test_forecasts_the_joint_that_is_too_slow():
    assert approach(limits(velocity=0.1)).forecast() == (
        "joint 'j0' needs at least 10.0 s at its velocity limit of 0.1 rad/s, "
        "and the time-out is 5 s (parameter timeout)"
    )


def test_a_shortfall_names_the_joint_that_is_farthest_off_and_its_error():
    said = approach().shortfall({"j0": 0.9, "j1": 0.0})
    assert said.startswith("joint 'j1' is at 0.0000, 0.5000 rad from -0.5000 (tolerance 0.02)")
    assert "joint 'j0' takes 0.5 s only" in said
    assert "another node commands the arm" in said


def test_a_shortfall_of_slow_joints_blames_their_limit():
    said = approach(limits(velocity=0.1)).shortfall({"j0": 0.5, "j1": -0.5})
    assert "needs at least 10.0 s" in said
    assert "another node" not in said


def test_a_shortfall_of_an_unknown_robot_makes_no_claim_on_time():
    said = approach(no_limits(NAMES)).shortfall(HOME)
    assert "takes" not in said
    assert "something is in its way" in said


def test_a_missing_joint_is_named_with_those_that_exist():
    said = approach(start={}).shortfall({"a": 0.0, "j0": 1.0})
    assert said == "no joint 'j1' in /joint_states, which has a, j0"


def test_silent_joint_states_are_told():
    assert "/joint_states is silent" in approach(start={}).shortfall({})
