"""The steps from a request to a trajectory: their order, and each way in which they fail."""

import math
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray
from planar_robot import planar_model

import arm_planning.planner
from arm_planning.collision.motion_proof import Obstruction
from arm_planning.constraints.constraints import JointConstraint, MotionConstraints, joint_goal
from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.pipeline import Timing, start_state, timed_and_proved
from arm_planning.planner import Planner
from arm_planning.planners.problem import Deadline, PlanningProblem
from arm_planning.request import PlanRequest
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.scene import PlanningScene
from arm_planning.trajectory import TimedTrajectory

MODEL = planar_model()
ARM = MODEL.group("arm")
SCENE = PlanningScene(
    {"shoulder": 0.0, "elbow": 0.0}, allowed=AllowedCollisions({("fore", "upper"): True})
)
CORNER = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
GOAL = (joint_goal({"shoulder": 1.0, "elbow": 1.0}),)
TOUCHING = Obstruction(1, 0.5, None, "box with fore")


def at(**positions: float) -> PlanningScene:
    return replace(SCENE, positions={**SCENE.positions, **positions})


def below(joint: str, highest: float) -> ConstraintEvaluator:
    """Return the constraint that a joint stays below a position."""
    constraint = JointConstraint(joint, highest - 10.0, above=10.0, below=10.0)
    path = MotionConstraints(joints=(constraint,))
    return ConstraintEvaluator(path, MODEL, ARM, SCENE.positions, lambda _q, _link: np.eye(4))


ANYWHERE = below("shoulder", 10.0)


@dataclass
class FakeChecker:
    """Proves a motion, or finds an obstruction, as often as there is one."""

    obstructions: list[Obstruction] = field(default_factory=list)
    timed: list[TimedTrajectory] = field(default_factory=list)

    def prove_driven(self, trajectory: TimedTrajectory) -> Obstruction | None:
        self.timed.append(trajectory)
        return self.obstructions.pop(0) if self.obstructions else None


def beside_the_corner(trajectory: TimedTrajectory) -> float:
    """Return how far a motion passes by the middle way point at most."""
    return float(np.linalg.norm(trajectory.positions - CORNER[1], axis=1).min())


def test_a_start_inside_its_limits_stays_as_it_is():
    begin = start_state(ARM, SCENE)
    assert (begin.positions, begin.remark) == (SCENE.positions, "")


def test_a_start_that_is_not_known_names_the_joint():
    with pytest.raises(PlanningError, match="the position of joint elbow is not known") as caught:
        start_state(ARM, PlanningScene({"shoulder": 0.0}))
    assert caught.value.code is MoveItErrorCode.START_STATE_INVALID


def test_a_start_slightly_outside_is_moved_inside_with_a_remark():
    begin = start_state(ARM, at(shoulder=3.005))
    assert begin.positions["shoulder"] == 3.0
    assert begin.remark.endswith("the plan moves joint 'shoulder' to 3.0000")


def test_a_start_far_outside_says_by_how_much():
    with pytest.raises(PlanningError, match=r"'elbow' is at -2\.6000.* by 0\.1000") as caught:
        start_state(ARM, at(elbow=-2.6))
    assert caught.value.code is MoveItErrorCode.START_STATE_INVALID


def test_a_corner_that_cannot_be_proved_is_made_tighter():
    checker = FakeChecker([TOUCHING, TOUCHING])
    found = timed_and_proved(CORNER, ARM, checker, ANYWHERE, Timing())
    distances = [beside_the_corner(trajectory) for trajectory in checker.timed]
    assert distances == sorted(distances, reverse=True)
    assert len(set(distances)) == 3
    assert found is checker.timed[-1]


def test_what_stays_obstructed_is_refused_with_the_place():
    with pytest.raises(PlanningError, match="motion is not free: box with fore") as caught:
        timed_and_proved(CORNER, ARM, FakeChecker([TOUCHING] * 99), ANYWHERE, Timing())
    assert caught.value.code is MoveItErrorCode.INVALID_MOTION_PLAN


def test_a_timed_motion_that_violates_the_constraints_is_refused():
    with pytest.raises(PlanningError, match="shoulder") as caught:
        timed_and_proved(CORNER, ARM, FakeChecker(), below("shoulder", 0.5), Timing())
    assert caught.value.code is MoveItErrorCode.INVALID_MOTION_PLAN


def test_constraints_are_looked_at_between_the_points_too():
    points = timed_and_proved(CORNER, ARM, None, ANYWHERE, Timing()).positions
    widest = int(np.argmax(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    between = (points[widest] + points[widest + 1]) / 2.0
    assert np.linalg.norm(points - between, axis=1).min() > 0.02

    class Hole(ConstraintEvaluator):
        def violation(self, q: NDArray[np.float64]) -> str:
            return "there is a hole" if np.linalg.norm(q - between) < 0.01 else ""

    hole = Hole(ANYWHERE.constraints, MODEL, ARM, SCENE.positions, lambda _q, _link: np.eye(4))
    with pytest.raises(PlanningError, match="there is a hole"):
        timed_and_proved(CORNER, ARM, None, hole, Timing())


def test_timing_ends_when_nobody_wants_it_any_more():
    deadline = Deadline(interrupted=lambda: True)
    with pytest.raises(PlanningError, match="interrupted while timing the path") as caught:
        timed_and_proved(CORNER, ARM, None, ANYWHERE, Timing(), deadline=deadline)
    assert caught.value.code is MoveItErrorCode.PREEMPTED


class FakePlanner:
    """Finds a path to the first goal state, whatever is in the way."""

    def plan(self, problem: PlanningProblem) -> NDArray[np.float64]:
        return np.vstack([problem.start, problem.goals.all()[0]])


@pytest.fixture
def planner(monkeypatch) -> Planner:
    monkeypatch.setattr(
        arm_planning.planner, "planner_for", lambda _name, _parameters: FakePlanner()
    )
    return Planner(MODEL, SCENE)


def test_a_plan_leads_from_the_corrected_start_to_the_goal_with_the_remark(planner):
    response = planner.plan(PlanRequest("arm", GOAL, start={"shoulder": 3.005}))
    assert response.trajectory is not None
    assert response.trajectory.positions[0].tolist() == [3.0, 0.0]
    assert response.trajectory.positions[-1] == pytest.approx([1.0, 1.0])
    assert response.start == {"shoulder": 3.0, "elbow": 0.0}
    assert response.message.startswith("the start state is slightly outside")


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_a_speed_that_is_no_fraction_and_a_time_without_end_change_no_plan(planner, value):
    usual = planner.plan(PlanRequest("arm", GOAL)).trajectory
    odd = PlanRequest("arm", GOAL, velocity_scaling=value, allowed_time_s=math.inf)
    found = planner.plan(odd).trajectory
    assert usual is not None
    assert found is not None
    assert found.times_s.tolist() == usual.times_s.tolist()


@pytest.mark.parametrize(
    ("request_", "code", "sentence"),
    [
        (PlanRequest("", GOAL), "INVALID_GROUP_NAME", "No group specified to plan for"),
        (PlanRequest("leg", GOAL), "INVALID_GROUP_NAME", "no group 'leg'"),
        (PlanRequest("arm", GOAL, start={"elbow": 9.0}), "START_STATE_INVALID", "'elbow' is at 9"),
        (PlanRequest("arm", GOAL, pipeline="stomp"), "FAILURE", "no pipeline 'stomp'"),
        (PlanRequest("arm", ()), "INVALID_GOAL_CONSTRAINTS", "the request has no goal"),
        (
            PlanRequest("arm", (joint_goal({"elbow": 1.0}),), allowed_time_s=-1.0),
            "TIMED_OUT",
            "the planning time ended while",
        ),
    ],
)
def test_a_failure_has_its_code_and_a_sentence(planner, request_, code, sentence):
    response = planner.plan(request_)
    assert response.trajectory is None
    assert response.code.name == code
    assert sentence in response.message


@pytest.mark.parametrize(
    ("elbow", "what"),
    [(0.0, "apart, closer than the 0.1 mm that the proof of a motion needs"), (0.5, "deep")],
)
def test_neighbours_that_touch_and_are_not_allowed_to_are_named(elbow, what):
    planner = Planner(MODEL, replace(at(elbow=elbow), allowed=AllowedCollisions()))
    response = planner.plan(PlanRequest("arm", (joint_goal({"shoulder": 1.0}),)))
    assert response.code is MoveItErrorCode.START_STATE_IN_COLLISION
    assert response.message.startswith("the start is in collision: fore with upper, ")
    assert response.message.endswith(
        f"{what}; if the two may touch, allow the pair in the SRDF (`arm planning srdf` finds such "
        "pairs), else jog them apart"
    )


@pytest.mark.parametrize("looks", [0, 1])
def test_an_interruption_ends_each_step(planner, looks):
    answers = iter([False] * looks)
    response = planner.plan(PlanRequest("arm", GOAL), interrupted=lambda: next(answers, True))
    assert response.code is MoveItErrorCode.PREEMPTED
    assert response.message.startswith("planning was interrupted while")
