"""The straight path in joint space, where it is free."""

import numpy as np
from numpy.typing import NDArray

from arm_planning.planners.problem import PlanningProblem
from arm_planning.planners.space import space_of

Array = NDArray[np.float64]


def straight_path(problem: PlanningProblem, goals: tuple[Array, ...]) -> Array | None:
    """Return the path to the first goal that needs no detour, (m, n); None if each needs one.

    With constraints on the way, the path follows them.
    """
    if not goals:
        return None
    space = space_of(problem, np.array(goals))
    for goal in goals:
        problem.deadline.check("looking for a straight path")
        states, reached = space.move(problem.start, goal)
        if reached:
            return np.vstack([problem.start, states])
    return None
