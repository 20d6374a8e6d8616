"""The suite's own planner: a straight path first, then RRT-Connect, shortcuts and a proof."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import ErrorCode, PlanningError
from arm_planning.planners.problem import PlanningProblem, StateChecker, path_length
from arm_planning.planners.rrt_connect import rrt_connect
from arm_planning.planners.shortcut import shorten
from arm_planning.planners.space import Space, space_of
from arm_planning.planners.straight import straight_to_any

Array = NDArray[np.float64]

RACE_FACTOR, RACE_EXTRA = 2, 32
"""After the first attempt found a path, the others may take so many iterations altogether."""


@dataclass(frozen=True, slots=True)
class RrtConnectPlanner:
    """Plans by RRT-Connect; the same problem with the same seed has the same answer.

    Iterations are counted, never timed: a busy machine gives the same path later, or none.
    """

    def plan(self, problem: PlanningProblem) -> Array:
        """Return a proved path, (m, n); see `PathPlanner`."""
        check_start(problem)
        path, goals = straight_to_any(problem)
        if path is not None:
            return path
        space = space_of(problem, goals)
        return shortest_proved(self._paths(problem, space, goals), problem.checker)

    def _paths(
        self, problem: PlanningProblem, space: Space, goals: Array
    ) -> Iterator[tuple[Array, ...]]:
        """Yield the path of each attempt: shortened, and as it was found."""
        for attempt, found in race(problem, space, goals):
            yield shorten(found, space, (problem.seed, attempt, 1), problem.deadline), found


def shortest_proved(paths: Iterable[tuple[Array, ...]], checker: StateChecker) -> Array:
    """Return the shortest path, (m, n), of which every state is proved free.

    Args:
        paths: of each attempt the versions of its path, the one to be preferred first.
        checker: proves them.

    Raises:
        PlanningError: PLANNING_FAILED: none can be proved.
    """
    shortest: Array | None = None
    for versions in paths:
        path = next((each for each in versions if checker.prove(each) is None), None)
        if path is not None and (shortest is None or path_length(path) < path_length(shortest)):
            shortest = path
    if shortest is None:
        raise PlanningError(
            ErrorCode.PLANNING_FAILED,
            "a path was found but not proved free; another seed may find a better one",
        )
    return shortest


def check_start(problem: PlanningProblem) -> None:
    """Raise an error if no path can begin at the start.

    Raises:
        PlanningError: START_STATE_IN_COLLISION or START_STATE_VIOLATES_PATH_CONSTRAINTS.
    """
    if not problem.checker.is_free(problem.start):
        contacts = problem.checker.contacts(problem.start)
        what = f": {contacts[0]}" if contacts else ""
        raise PlanningError(ErrorCode.START_STATE_IN_COLLISION, f"the start is in collision{what}")
    if problem.path is not None:
        violation = problem.path.violation(problem.start)
        if violation:
            raise PlanningError(
                ErrorCode.START_STATE_VIOLATES_PATH_CONSTRAINTS,
                f"the start violates the path constraints: {violation}",
            )


def race(problem: PlanningProblem, space: Space, goals: Array) -> Iterator[tuple[int, Array]]:
    """Search with several streams of random numbers in turn; yield each path that is found.

    Yields:
        The number of the attempt and its path. An attempt that takes much longer than the first
        to succeed is given up.

    Raises:
        PlanningError: TIMED_OUT.
    """
    searches = {
        attempt: rrt_connect(space, problem.start, goals, (problem.seed, attempt))
        for attempt in range(problem.attempts)
    }
    iterations, last = 0, np.inf
    while searches and iterations < last:
        iterations += 1
        for attempt, search in list(searches.items()):
            problem.deadline.check("searching for a path")
            path = next(search)
            if path is not None:
                del searches[attempt]
                last = min(last, RACE_FACTOR * iterations + RACE_EXTRA)
                yield attempt, path
