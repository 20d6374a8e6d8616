"""The straight path in joint space, where it is free."""

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import PlanningProblem
from arm_planning.planners.space import space_of

Array = NDArray[np.float64]


def straight_to_any(problem: PlanningProblem) -> tuple[Array | None, Array]:
    """Return a proved straight path to a goal, (m, n), if there is one, else all goals, (g, n).

    Raises:
        PlanningError: there is no goal state.
    """
    first = problem.goals.nearest()
    path, goals = straight_path(problem, first), first
    if path is None:
        goals = problem.goals.all()
        path = straight_path(problem, tuple(goal for goal in goals if not _is_in(goal, first)))
    if path is not None and problem.checker.prove(path) is None:
        return path, np.array(goals)
    return None, np.array(problem.goals.all() if goals is first else goals)


def _is_in(goal: Array, others: tuple[Array, ...]) -> bool:
    return any(np.array_equal(goal, other) for other in others)


def straight_path(problem: PlanningProblem, goals: tuple[Array, ...]) -> Array | None:
    """Return the path to the first goal that needs no detour, (m, n); None if each needs one.

    With constraints on the way, the path follows them.
    """
    if not goals:
        return None
    space = space_of(problem, np.array(goals))
    for goal in goals:
        problem.deadline.check("looking for a straight path")
        states = space.connect(problem.start, goal)
        if states is not None:
            return np.vstack([problem.start, states])
    return None
