"""What tests expect of joints, and the sentences about what happened instead."""

from math import nan

import pytest

from arm_sim.bench.expectations import TargetCheck, violations
from arm_sim.bench.history import StateHistory
from arm_sim.errors import CallError, UnknownNameError


@pytest.fixture
def history() -> StateHistory:
    history = StateHistory(["a", "b"], ["rad", "m"])
    history.add(0.0, [0.0, 0.0], [0.0, 0.0], [0.0, 0.0])
    return history


def add(history: StateHistory, time_s: float, a: float, b: float = 0.0, speed: float = 0.0) -> None:
    history.add(time_s, [a, b], [speed, 0.0], [0.0, 0.0])


def test_joints_reach_a_target_all_at_the_same_time(history):
    reaching = TargetCheck(history, [1.0, 2.0], 0.01)
    add(history, 0.1, 1.0, 0.0)
    assert not reaching()
    add(history, 0.2, 0.0, 2.0)
    assert not reaching()
    add(history, 0.3, 1.005, 2.005)
    assert reaching()


def test_joints_that_are_not_named_may_be_anywhere(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01)
    add(history, 0.1, 1.0, 77.0)
    assert reaching()


def test_a_state_between_two_looks_counts(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01)
    add(history, 0.1, 1.0)
    add(history, 0.2, 5.0)
    assert reaching()


def test_joints_that_must_stay_have_not_reached_it_before(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01, hold_s=0.2)
    for tenth, position in enumerate([1.0, 1.0, 0.0, 1.0, 1.0], start=1):
        add(history, 0.1 * tenth, position)
        assert not reaching()
    add(history, 0.6, 1.0)
    assert reaching()


def test_a_position_that_is_not_a_number_is_not_at_a_target(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01)
    add(history, 0.1, nan)
    assert not reaching()
    assert "a: at nan rad" in reaching.explain(0.1)


def test_the_message_says_where_each_joint_is_and_since_when(history):
    reaching = TargetCheck(history, [1.0, 0.0], 0.01)
    add(history, 0.1, 0.4, speed=0.5)
    add(history, 0.2, 0.4)
    assert not reaching()
    assert reaching.explain(0.2).splitlines() == [
        "the joints do not reach the target within 0.2 s",
        "  a: at 0.4000 rad, 0.6000 rad from 1.0000 rad (tolerance 0.01); "
        "it has been at rest since 0.100 s",
        "  b: at the target",
    ]


def test_the_message_says_that_a_joint_still_moves(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01)
    add(history, 0.1, 0.4, speed=0.5)
    assert not reaching()
    assert "it moves at 0.5000 rad/s" in reaching.explain(0.1)


def test_the_message_says_that_joints_did_not_stay(history):
    reaching = TargetCheck(history, {"a": 1.0}, 0.01, hold_s=1.0)
    add(history, 0.1, 1.0)
    assert not reaching()
    assert reaching.explain(0.1) == (
        "the joints are at the target, but do not stay for 1 s within 0.1 s"
    )


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ([1.0], "the target has 1 values, and the robot 2 joints: a, b"),
        ({"c": 1.0}, "no joint 'c'; the robot has a, b"),
        ({"a": nan}, "finite positions"),
        ({}, "finite positions of at least one joint"),
    ],
)
def test_a_target_that_cannot_be_one_is_refused(history, target, message):
    with pytest.raises((CallError, UnknownNameError), match=message):
        TargetCheck(history, target, 0.01)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, nan])
def test_a_tolerance_must_be_positive(history, tolerance):
    with pytest.raises(CallError, match="tolerance must be positive"):
        TargetCheck(history, {"a": 1.0}, tolerance)


def test_values_within_bounds_are_no_violation(history):
    add(history, 0.1, 1.0, -1.0)
    assert violations(history, "position", 1.0) == []
    assert violations(history, "position", {"b": (-1.0, 0.0)}) == []


def test_a_violation_says_the_worst_value_and_when(history):
    for tenth, speed in enumerate([0.5, 1.5, -2.0, 0.5, 1.2], start=1):
        add(history, 0.1 * tenth, 0.0, speed=speed)
    assert violations(history, "velocity", 1.0) == [
        "a: velocity -2.0000 rad/s at 0.300 s, beyond -1.0000 rad/s; first at 0.200 s, last at "
        "0.500 s, 2 times"
    ]


def test_a_value_that_is_not_a_number_violates_every_bound(history):
    add(history, 0.1, nan)
    (sentence,) = violations(history, "position", {"a": 100.0})
    assert sentence.startswith("a: position nan rad at 0.100 s")


@pytest.mark.parametrize(
    ("limit", "message"),
    [
        ((1.0, -1.0), "cannot be between 1.0 and -1.0"),
        (nan, "cannot be between"),
        ({"c": 1.0}, "no joint 'c'"),
    ],
)
def test_bounds_that_cannot_be_any_are_refused(history, limit, message):
    with pytest.raises((CallError, UnknownNameError), match=message):
        violations(history, "velocity", limit)
