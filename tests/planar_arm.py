"""An arm in a plane among discs, whose collisions and clearances are exact: for fast tests."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from robots import joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_planning.constraints.constraints import MotionConstraints
from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.planners.problem import NO_DEADLINE, Deadline, PlanningProblem
from arm_planning.robot.model import JointGroup, PlanningLimits, PlanningModel

FLOOR_M = 1e-4
Disc = tuple[float, float, float]
"""x, y and radius in m."""


@dataclass(frozen=True)
class Blocked:
    """Where a proof failed."""

    segment: int
    fraction: float
    away: np.ndarray | None = None

    def __str__(self) -> str:
        return f"the arm with a disc in segment {self.segment}"


@dataclass
class PlanarArm:
    """Links of 1 m that turn about z, thin, among discs; it is its own checker."""

    discs: tuple[Disc, ...] = ()
    checks: int = 0

    def points(self, q: np.ndarray) -> np.ndarray:
        """The joints and the tip, (n + 1, 2)."""
        angles = np.cumsum(q)
        steps = np.column_stack([np.cos(angles), np.sin(angles)])
        return np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])

    def clearance(self, q: np.ndarray) -> float:
        """Distance in m from the links to the discs; negative inside of one."""
        self.checks += 1
        if not self.discs:
            return math.inf
        points = self.points(q)
        discs = np.array(self.discs)
        start, along = points[:-1], np.diff(points, axis=0)
        part = np.clip(np.einsum("djk,jk->dj", discs[:, None, :2] - start, along), 0.0, 1.0)
        nearest = start + part[:, :, None] * along
        gaps = np.linalg.norm(discs[:, None, :2] - nearest, axis=2) - discs[:, None, 2]
        return float(gaps.min())

    def is_free(self, q: np.ndarray) -> bool:
        return self.clearance(q) > 0.0

    def free_count(self, states: np.ndarray, clearance_m: float = 0.0) -> int:
        free = (self.clearance(q) > clearance_m for q in states)
        return sum(itertools.takewhile(bool, free))

    def is_free_edge(self, a: np.ndarray, b: np.ndarray) -> bool:
        return self.prove(np.array([a, b])) is None

    def prove(self, path: np.ndarray) -> Blocked | None:
        for segment, (a, b) in enumerate(itertools.pairwise(path)):
            fraction = self._obstruction(a, b - a, 0.0, 1.0)
            if fraction is not None:
                return Blocked(segment, fraction, self._away(a + fraction * (b - a)))
        return None

    def _away(self, q: np.ndarray) -> np.ndarray:
        gains = [self.clearance(q + step) - self.clearance(q) for step in 1e-6 * np.eye(len(q))]
        return np.array(gains) / np.linalg.norm(gains)

    def _obstruction(
        self, start: np.ndarray, change: np.ndarray, low: float, high: float
    ) -> float | None:
        """No point moves farther than each joint's change times the length beyond it."""
        middle = (low + high) / 2.0
        sweep = (high - low) / 2.0 * float(np.abs(change) @ np.arange(len(start), 0, -1))
        clearance = self.clearance(start + middle * change)
        if clearance < FLOOR_M:
            return middle
        if clearance > sweep:
            return None
        before = self._obstruction(start, change, low, middle)
        return self._obstruction(start, change, middle, high) if before is None else before

    def contacts(self, q: np.ndarray) -> tuple[str, ...]:
        return () if self.is_free(q) else (f"the arm with a disc, {-self.clearance(q):.2f} m deep",)

    def pose(self, q: np.ndarray, name: str) -> np.ndarray:
        """Pose of link `l0` to `l<n>`, which ends at a joint; the last is the tip."""
        count = int(name[1:])
        result = np.eye(4)
        angle = float(np.sum(q[:count]))
        result[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        result[:2, 3] = self.points(q)[count]
        return result


def planar_model(joints: int, limit: float = 3.0) -> PlanningModel:
    """The model of a planar arm with a group "arm"; `l0` is fixed."""
    names = tuple(f"j{index}" for index in range(joints))
    links = tuple(f"l{index}" for index in range(joints + 1))
    text = robot(
        *map(link, links),
        *(
            joint(name, links[index], links[index + 1], axis="0 0 1", limits=(-limit, limit))
            for index, name in enumerate(names)
        ),
    )
    limits = (PlanningLimits(-limit, limit, 3.0, 3.0),) * joints
    group = JointGroup("arm", names, (False,) * joints, limits, links[1:], "l0", links[-1])
    return PlanningModel(parse_urdf(text), "l0", names, {"arm": group})


@dataclass(frozen=True)
class States:
    """Goals that are known."""

    states: tuple[np.ndarray, ...]

    def nearest(self) -> tuple[np.ndarray, ...]:
        return self.states[:1]

    def all(self) -> tuple[np.ndarray, ...]:
        return self.states


def planar_problem(
    arm: PlanarArm,
    start: list[float],
    *goals: list[float],
    path: MotionConstraints | None = None,
    deadline: Deadline = NO_DEADLINE,
    seed: int = 0,
    attempts: int = 1,
) -> PlanningProblem:
    """A path to find for a planar arm."""
    model = planar_model(len(start))
    group = model.group("arm")
    evaluator = path and ConstraintEvaluator(path, model, group, {}, arm.pose)
    states = States(tuple(np.array(goal) for goal in goals))
    return PlanningProblem(group, np.array(start), states, arm, evaluator, deadline, seed, attempts)


def dense(path: np.ndarray) -> np.ndarray:
    """States at every 0.001 rad of a path."""
    return np.concatenate(
        [
            np.linspace(a, b, 2 + int(np.abs(b - a).max() / 1e-3))
            for a, b in itertools.pairwise(path)
        ]
    )
