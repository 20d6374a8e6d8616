"""The cases of upstream's test_tolerances.cpp, and the bounds of errors."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import (
    ErrorCode,
    GoalOutcome,
    GoalRequest,
    JointTolerance,
    ToleranceError,
    Tolerances,
)

JOINTS = ("j0", "j1", "j2")
INF = np.inf

Ask = Callable[..., Tolerances]


@pytest.fixture
def defaults() -> Tolerances:
    return Tolerances.of(
        path=np.full(3, 0.1), goal=np.full(3, 0.1), stopped_velocity=0.01, goal_time_s=0.1
    )


@pytest.fixture
def ask(defaults, make_request) -> Ask:
    """Resolve the tolerances of a goal."""

    def resolve(**options: Any) -> Tolerances:
        return defaults.for_goal(
            GoalRequest(1, make_request([(1.0, [0.0] * 3)]), **options), JOINTS
        )

    return resolve


def test_get_segment_tolerances(ask):
    resolved = ask(
        path_tolerance=[JointTolerance(name, 0.2, 0.3, 0.4) for name in JOINTS],
        goal_tolerance=[
            JointTolerance("j1", 1.2, 2.2, 3.2),
            JointTolerance("j2", 1.3, 2.3, 3.3),
            JointTolerance("j0", 1.1, 2.1, 3.1),
        ],
        goal_time_tolerance_s=2.0,
    )

    assert resolved.goal_time_s == 2.0
    assert resolved.path.values.T.tolist() == [[0.2, 0.3, 0.4]] * 3
    assert resolved.goal.values.T.tolist() == [[1.1, 2.1, 3.1], [1.2, 2.2, 3.2], [1.3, 2.3, 3.3]]


def test_deactivate_tolerances(ask):
    off = [JointTolerance(name, -1.0, -1.0, -1.0) for name in JOINTS]
    resolved = ask(path_tolerance=off, goal_tolerance=off, goal_time_tolerance_s=-1.0)

    assert resolved.goal_time_s == 0.0
    assert not resolved.path.is_any
    assert not resolved.goal.is_any


@pytest.mark.parametrize("where", ["path_tolerance", "goal_tolerance"])
@pytest.mark.parametrize("quantity", ["position", "velocity", "acceleration"])
def test_invalid_tolerances(ask, where, quantity):
    with pytest.raises(ToleranceError, match=f"{quantity} tolerance of joint 'j0' is -123"):
        ask(**{where: [JointTolerance("j0", **{quantity: -123.0})]})


@pytest.mark.parametrize("where", ["path_tolerance", "goal_tolerance"])
def test_invalid_joints(ask, where):
    with pytest.raises(ToleranceError, match="no joint 'j123'; the joints are j0, j1, j2"):
        ask(**{where: [JointTolerance("j123", 1.0)]})


def test_invalid_goal_time(ask):
    with pytest.raises(ToleranceError, match="goal_time_tolerance is -123"):
        ask(goal_time_tolerance_s=-123.0)


def test_zero_asks_for_the_default(ask, defaults):
    resolved = ask(path_tolerance=[JointTolerance("j1", velocity=0.5)])

    assert resolved.path.values[:, 1].tolist() == [0.1, 0.5, INF]
    assert resolved.goal.values.tolist() == defaults.goal.values.tolist()
    assert resolved.goal_time_s == 0.1


def test_the_defaults_are_as_the_parameters_say(defaults):
    assert defaults.path.values[:, 0].tolist() == [0.1, INF, INF]
    assert defaults.goal.values[:, 0].tolist() == [0.1, 0.01, INF]


def test_zero_and_less_in_the_parameters_is_no_tolerance():
    tolerances = Tolerances.of(np.array([0.0, -1.0]), np.zeros(2), 0.0, 0.0)

    assert not tolerances.path.is_any
    assert not tolerances.goal.is_any


class TestHold:
    def test_within(self, defaults):
        assert defaults.path.hold(np.array([[0.1, -0.1, 0.0]]))

    def test_outside(self, defaults):
        assert not defaults.path.hold(np.array([[0.0, -0.11, 0.0]]))

    def test_rows_without_errors_do_not_count(self, defaults):
        assert defaults.goal.hold(np.zeros((1, 3)))
        assert not defaults.goal.hold(np.array([[0.0] * 3, [0.02] * 3]))

    def test_a_broken_sensor_is_outside(self, defaults):
        assert not defaults.path.hold(np.array([[np.nan, 0.0, 0.0]]))

    def test_only_that_of_what_is_checked_is(self, ask):
        bounds = ask(path_tolerance=[JointTolerance("j0", -1.0)]).path

        assert bounds.hold(np.array([[np.nan, 0.0, 0.0], [np.nan, 0.0, 0.0]]))
        assert bounds.excess(np.array([[np.nan, 0.0, np.nan]]), JOINTS) == (
            "position error of joint j2 is nan, tolerance 0.100000"
        )

    def test_what_is_not_checked_is_never_outside(self, defaults):
        off = defaults.switched_off()

        assert off.path.hold(np.full((3, 3), 1e9))
        assert off.goal.hold(np.full((3, 3), np.nan))

    def test_the_culprit_is_named(self, defaults):
        assert defaults.goal.excess(np.array([[0.0] * 3, [0.0, 0.5, 0.0]]), JOINTS) == (
            "velocity error of joint j1 is 0.500000, tolerance 0.010000"
        )


POINTS = [(0.5, [0.0, 0.6, 0.0])]
OFF = [JointTolerance("j1", -1.0)]


@pytest.mark.parametrize("options", [{}, {"goal_tolerance": OFF}, {"goal_time_tolerance_s": -1.0}])
def test_a_joint_that_rests_far_from_its_end_has_not_arrived(make_rig, options):
    rig = make_rig()
    rig.moves = False
    rig.place([0.0, 0.3, 0.0])
    rig.goal(POINTS, **options)
    rig.run(0.9)
    assert rig.result is None
    rig.run(0.2)
    assert rig.result.outcome is GoalOutcome.ABORTED
    assert rig.result.code is ErrorCode.GOAL_TOLERANCE_VIOLATED
    assert rig.result.message == (
        "Aborted: joint j1 does not follow: it rests 0.3 rad from the goal; "
        "constraints.j1.goal allows a larger error"
    )
    # It holds where it is.
    rig.tick()
    assert rig.commanded().tolist() == pytest.approx([0.0, 0.3, 0.0])


def test_a_joint_that_is_late_but_comes_closer_succeeds_by_time(make_rig):
    rig = make_rig()
    rig.moves = False
    rig.goal(POINTS)
    rig.run(0.5)
    for cycle in range(51):
        rig.place([0.0, 0.3 + cycle * 0.001, 0.0])
        rig.tick()
    assert rig.result is not None
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_the_error_of_a_weak_drive_does_not_matter(make_rig):
    rig = make_rig()
    rig.moves = False
    rig.place([0.0, 0.56, 0.0])
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_a_sliding_joint_is_far_from_millimetres_on(make_rig, robot_description):
    rig = make_rig(robot_description=robot_description("prismatic"))
    rig.moves = False
    rig.goal([(0.5, [0.0, 0.02, 0.0])])
    rig.run(1.2)
    assert "joint j1 does not follow: it rests 0.02 m from" in rig.result.message


def test_a_tolerance_of_the_user_decides(make_rig):
    rig = make_rig(constraints__j1__goal=0.4)
    rig.moves = False
    rig.place([0.0, 0.3, 0.0])
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED


def test_a_joint_that_is_not_commanded_does_not_count(make_rig):
    rig = make_rig(command_joints=("j0", "j2"))
    rig.moves = False
    rig.goal(POINTS)
    rig.run(0.52)
    assert rig.result.outcome is GoalOutcome.SUCCEEDED
