"""States of a group that satisfy a goal: free, within the limits, near the start first."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.constraints.constraints import MotionConstraints
from arm_planning.constraints.evaluation import ConstraintEvaluator, LinkPose
from arm_planning.errors import InvalidGoalError, MoveItErrorCode, PlanningError
from arm_planning.kinematics.group_kinematics import GroupKinematics
from arm_planning.kinematics.inverse import is_new
from arm_planning.planners.goal_poses import poses_of
from arm_planning.planners.problem import NO_DEADLINE, Deadline, StateChecker
from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel

Array = NDArray[np.float64]

MOST = 8
"""Goal states to choose from."""
SAMPLES = 64
"""Joint positions, or poses, that are drawn for a goal whose middle cannot be reached."""
WIDE = 0.1
"""Tolerance of an orientation, in rad, from which other orientations are tried as well."""
SLACK = 1e-4
"""How much inverse kinematics may miss a tolerance, rad or m."""
FULL_TURN = 2.0 * math.pi
DOING = "looking for a goal state"


@dataclass(frozen=True, slots=True, eq=False)
class GoalSampler:
    """Samples goal states; the same ones for the same seed. It is a `GoalSource`.

    Attributes:
        goals: alternatives; each is met as a whole.
        path: what holds on the whole way, and so at the goal.
        model: the robot.
        group: the group whose positions vary.
        positions: positions of the robot's other active joints.
        pose: poses of links.
        inverse: inverse kinematics; poses are goals of a group only with it.
        checker: what is free.
        start: where the path begins, (n,).
        seed: seed of the random numbers.
        deadline: when the answer is due.
    """

    goals: tuple[MotionConstraints, ...]
    path: MotionConstraints
    model: PlanningModel
    group: JointGroup
    positions: JointPositions
    pose: LinkPose
    inverse: GroupKinematics | None
    checker: StateChecker
    start: Array
    seed: int = 0
    deadline: Deadline = NO_DEADLINE

    def nearest(self) -> tuple[Array, ...]:
        """Return the goal states that the middles of the goals give; there may be none."""
        found: list[Array] = []
        for goal in self._alternatives():
            judge = _Judge(self, goal)
            found += filter(judge.accepts, self._first_candidates(goal, judge))
        return self._sorted(found)

    def all(self) -> tuple[Array, ...]:
        """Return up to `MOST` different goal states.

        Raises:
            PlanningError: there is none; the message gives the reason of the first alternative.
        """
        found: list[Array] = []
        judges: list[_Judge] = []
        for goal in self._alternatives():
            judge = _Judge(self, goal)
            judges.append(judge)
            found += self._accepted(goal, judge)
        if not found:
            raise judges[0].error()
        return self._sorted(found)[:MOST]

    def _accepted(self, goal: MotionConstraints, judge: "_Judge") -> list[Array]:
        """Return up to `MOST` different states that a judge accepts, fewer if the time ends.

        Raises:
            PlanningError: the time ended before there was one, and why none was accepted so far.
        """
        found: list[Array] = []
        try:
            for candidate in self._candidates(goal, judge):
                self.deadline.check(DOING)
                if judge.accepts(candidate) and is_new(candidate, found):
                    found.append(candidate)
                if len(found) == MOST:
                    break
        except PlanningError as error:
            if error.code is not MoveItErrorCode.TIMED_OUT:
                raise
            if not found:
                raise judge.error_at(error) from error
        return found

    def _alternatives(self) -> list[MotionConstraints]:
        goals = [goal for goal in self.goals if goal]
        if not goals:
            raise InvalidGoalError(
                "the request has no goal: it needs constraints on joints, positions or orientations"
            )
        return goals

    def _sorted(self, states: list[Array]) -> tuple[Array, ...]:
        return tuple(sorted(states, key=lambda q: float(np.linalg.norm(q - self.start))))

    def _first_candidates(self, goal: MotionConstraints, judge: "_Judge") -> Iterator[Array]:
        if not goal.positions and not goal.orientations:
            yield self._joint_candidate(goal, None)
            return
        for link, pose, any_turn in poses_of(self._merged(goal), self.pose, self.start, None):
            yield from self._inverse(link, pose, any_turn, judge, most=1)

    def _merged(self, goal: MotionConstraints) -> MotionConstraints:
        """Return a goal of a pose with what the constraints on the way say of poses."""
        return MotionConstraints(
            positions=goal.positions + self.path.positions,
            orientations=goal.orientations + self.path.orientations,
        )

    def _candidates(self, goal: MotionConstraints, judge: "_Judge") -> Iterator[Array]:
        """Yield the middle of the goal, then samples if it is wide or its middle is no use."""
        random = np.random.default_rng((self.seed, 2))
        if not goal.positions and not goal.orientations:
            yield self._joint_candidate(goal, None)
            for _ in range(SAMPLES):
                if judge.accepted:
                    return
                yield self._joint_candidate(goal, random)
            return
        merged = self._merged(goal)
        is_wide = _is_wide(merged)
        for link, pose, any_turn in poses_of(merged, self.pose, self.start, None):
            yield from self._inverse(link, pose, any_turn, judge, most=MOST)
        for index in range(SAMPLES):
            if judge.accepted and (index >= MOST or not is_wide):
                return
            for link, pose, any_turn in poses_of(
                merged, self.pose, self._random_state(random), random
            ):
                yield from self._inverse(link, pose, any_turn, judge, most=2)

    def _random_state(self, random: np.random.Generator) -> Array:
        lower = np.maximum(self.group.lower, self.start - math.pi)
        upper = np.minimum(self.group.upper, self.start + math.pi)
        return random.uniform(lower, np.maximum(lower, upper))

    def _joint_candidate(
        self, goal: MotionConstraints, random: np.random.Generator | None
    ) -> Array:
        """Return the goal of each joint, or a random position in its tolerance.

        A joint that the goal does not name stays at the start, or is anywhere.
        """
        q = self.start.copy() if random is None else self._random_state(random)
        index = {joint: number for number, joint in enumerate(self.group.joints)}
        for each in goal.joints:
            if each.joint not in index:
                continue
            at = index[each.joint]
            limits = self.group.limits[at]
            low = max(each.position - each.below, limits.lower)
            high = min(each.position + each.above, limits.upper)
            middle = min(max(each.position, low), high)
            q[at] = middle if random is None else random.uniform(low, high)
        return self._beside_start(q)

    def _inverse(
        self, link: str, pose: Array, any_turn: bool, judge: "_Judge", *, most: int
    ) -> Iterator[Array]:
        self.deadline.check(DOING)
        if self.inverse is None:
            raise PlanningError(
                MoveItErrorCode.NO_IK_SOLUTION,
                f"group '{self.group.name}' has no inverse kinematics; give a goal of its joints",
            )
        try:
            found = self.inverse(
                link, pose, self.start, most=most, random_seed=self.seed, any_turn=any_turn
            )
        except PlanningError as error:
            judge.unreachable(error)
            return
        for q in found:
            yield self._beside_start(q)

    def _beside_start(self, q: Array) -> Array:
        """Return positions with each continuous joint within half a turn of the start."""
        turns = np.round((q - self.start) / FULL_TURN) * FULL_TURN
        return np.where(self.group.continuous, q - turns, q)


class _Judge:
    """Accepts candidates of one goal, and remembers why it accepted none."""

    def __init__(self, sampler: GoalSampler, goal: MotionConstraints) -> None:
        self._sampler = sampler
        self._goal = self._evaluator(goal)
        self._path = self._evaluator(sampler.path)
        self.accepted = 0
        self._errors: dict[int, PlanningError] = {}

    def _evaluator(self, constraints: MotionConstraints) -> ConstraintEvaluator:
        sampler = self._sampler
        return ConstraintEvaluator(
            constraints, sampler.model, sampler.group, sampler.positions, sampler.pose
        )

    def accepts(self, q: Array) -> bool:
        """Return whether a state is within the limits, satisfies the goal, and is free."""
        error = self._objection(q)
        if error is None:
            self.accepted += 1
            return True
        self._errors.setdefault(error[0], PlanningError(error[1], error[2]))
        return False

    def unreachable(self, error: PlanningError) -> None:
        """Remember that inverse kinematics found nothing."""
        self._errors.setdefault(3, PlanningError(error.code, f"goal is out of reach: {error}"))

    def error(self) -> PlanningError:
        """Return the reason why no state was accepted: of the candidate that came farthest."""
        if not self._errors:
            return PlanningError(
                MoveItErrorCode.GOAL_STATE_INVALID, "no state was found that satisfies the goal"
            )
        return self._errors[min(self._errors)]

    def error_at(self, end: PlanningError) -> PlanningError:
        """Return the reason so far and that the time ended, or only that."""
        if not self._errors:
            return end
        reason = self._errors[min(self._errors)]
        return PlanningError(reason.code, f"{reason}; the planning time ended with that")

    def _objection(self, q: Array) -> tuple[int, MoveItErrorCode, str] | None:
        """Return what speaks against a state; the number is smaller the farther it came."""
        group, checker = self._sampler.group, self._sampler.checker
        outside = np.maximum(group.lower - q, q - group.upper)
        worst = int(np.argmax(outside))
        if outside[worst] > 0.0:
            limits = group.limits[worst]
            return (
                4,
                MoveItErrorCode.GOAL_STATE_INVALID,
                f"goal is outside of the limits: joint '{group.joints[worst]}' at {q[worst]:.4g} "
                f"has the limits {limits.lower:.4g} and {limits.upper:.4g}",
            )
        violation = _violation(self._goal, q)
        if violation:
            return 2, MoveItErrorCode.GOAL_CONSTRAINTS_VIOLATED, f"goal cannot be met: {violation}"
        violation = self._path.violation(q)
        if violation:
            return (
                1,
                MoveItErrorCode.GOAL_VIOLATES_PATH_CONSTRAINTS,
                f"goal violates the path constraints: {violation}",
            )
        if checker.is_free(q):
            return None
        contacts = checker.contacts(q)
        what = f": {contacts[0]}" if contacts else ""
        return 0, MoveItErrorCode.GOAL_IN_COLLISION, f"goal is in collision{what}"


def _violation(goal: ConstraintEvaluator, q: Array) -> str:
    return next((each.sentence for each in goal.results(q) if each.excess > SLACK), "")


def _is_wide(goal: MotionConstraints) -> bool:
    """Whether a goal leaves so much open that its middle is only one of many."""
    turns = [max(each.tolerances) for each in goal.orientations]
    return max(turns, default=0.0) > WIDE or not (goal.positions and goal.orientations)
