"""What solutions cost: a stage's solutions are sorted by it, and a task's by their sum."""

from collections.abc import Callable, Mapping

import numpy as np

from arm_planning.collision.proximity import Proximity
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planner import Planner
from arm_planning.scene.scene import PlanningScene
from arm_planning.tasks.solution import Solution

Cost = Callable[[Solution, Planner], float]
"""Returns the cost of a solution without parts.

It raises PlanningError to refuse the solution.
"""
FARTHEST_M = 1.0
"""Clearances beyond this are all alike."""


def duration(solution: Solution, _planner: Planner) -> float:
    """Return how long the motion takes, in s."""
    return 0.0 if solution.trajectory is None else solution.trajectory.duration_s


def path_length(solution: Solution, _planner: Planner) -> float:
    """Return by how much the joints move, all together, in rad and m."""
    if solution.trajectory is None:
        return 0.0
    return float(np.abs(np.diff(solution.trajectory.positions, axis=0)).sum())


def link_motion(link: str) -> Cost:
    """Return the cost that counts how far a link moves, in m."""

    def cost(solution: Solution, planner: Planner) -> float:
        if solution.trajectory is None:
            return 0.0
        joints, scene = solution.trajectory.joints, solution.start
        places = [
            planner.link_pose(link, _at(scene.positions, joints, q)).position
            for q in solution.trajectory.positions.tolist()
        ]
        return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())

    return cost


def clearance(group: str, *, with_world: bool = True, cumulative: bool = False) -> Cost:
    """Return the cost that prefers a state far from what it may not touch, in 1/m.

    Args:
        group: the group whose state it is.
        with_world: whether the world's objects count; otherwise the robot's own links do.
        cumulative: whether each pair of bodies counts, or the nearest one alone.
    """

    def cost(solution: Solution, planner: Planner) -> float:
        model = planner.checker(solution.end, group).model
        proximity = Proximity(model)
        q = np.array([solution.end.positions[joint] for joint in model.joints])
        found = proximity.near(q, FARTHEST_M)
        near = [d for pair, d in found.items() if proximity.is_with_world(pair) == with_world]
        if any(distance <= 0.0 for distance in near):
            raise PlanningError(MoveItErrorCode.GOAL_IN_COLLISION, "the state is in collision")
        inverse = [1.0 / distance for distance in near]
        return (sum(inverse) if cumulative else max(inverse, default=0.0)) or 1.0 / FARTHEST_M

    return cost


def _at(positions: Mapping[str, float], joints: tuple[str, ...], q: list[float]) -> PlanningScene:
    return PlanningScene({**positions, **dict(zip(joints, q, strict=True))})
