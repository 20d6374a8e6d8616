"""The suite's own planner: a straight path first, then RRT-Connect, shortcuts and a proof."""

import logging
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import MoveItErrorCode, NoPlanError, PlanningError
from arm_planning.planners.mend import mend
from arm_planning.planners.problem import PlanningProblem, path_length
from arm_planning.planners.rrt_connect import REACH, rrt_connect
from arm_planning.planners.shortcut import shorten
from arm_planning.planners.space import Space, space_of

Array = NDArray[np.float64]
_logger = logging.getLogger(__name__)
SAMPLED_ROUNDS = 3
"""How often a path is searched for by samples before each move is proved: another search often
takes another way, and proofs take several times as long."""
RACE_FACTOR, RACE_EXTRA = 2, 32
"""After the first attempt found a path, the others may take so many iterations altogether."""


@dataclass(frozen=True, slots=True)
class RrtConnectPlanner:
    """Plans by RRT-Connect; the same problem with the same seed has the same answer.

    Iterations are counted, never timed: a busy machine gives the same path later, or none. Of
    several attempts, those that finish in time count.

    Attributes:
        reach: longest move of a tree, in the joints' units.
    """

    reach: float = REACH

    def plan(self, problem: PlanningProblem) -> Array:
        """Return a proved path, (m, n); see `PathPlanner`."""
        check_start(problem)
        path, goals = straight_to_any(problem)
        if path is not None:
            return path
        check_start_is_proved(problem)
        paths: list[Array] = []
        for number in range(SAMPLED_ROUNDS + 1):
            # Where samples do not tell what is free, each move is proved.
            is_proved = number == SAMPLED_ROUNDS
            paths = paths or list(self._paths(problem, goals, number, is_proved=is_proved))
        if not paths:
            raise NoPlanError(
                "a path was found but not proved free; another seed may find a better one"
            )
        return min(paths, key=path_length)

    def _paths(
        self, problem: PlanningProblem, goals: Array, number: int, *, is_proved: bool
    ) -> Iterator[Array]:
        """Yield the path of each attempt that succeeds, shortened and proved."""
        space = space_of(problem, goals, is_proved=is_proved)
        has_path = False
        try:
            for attempt, found in race(problem, space, goals, self.reach, number):
                path = shortened_and_proved(problem, space, found, attempt)
                if path is not None:
                    has_path = True
                    yield path
        except PlanningError as error:
            # The time that further attempts lack is no reason to lose the path of a finished one.
            if error.code is not MoveItErrorCode.TIMED_OUT or not has_path:
                raise
            _logger.warning(
                "the planning time ended before all %d attempts did: the best of those that "
                "finished is returned, and a busier machine may return another",
                problem.attempts,
            )


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


def _is_in(goal: Array, others: tuple[Array, ...]) -> bool:
    return any(np.array_equal(goal, other) for other in others)


def shortened_and_proved(
    problem: PlanningProblem, space: Space, found: Array, attempt: int
) -> Array | None:
    """Return a path that was found in a space, (m, n), shortened and proved; None without proof."""
    seed = (problem.seed, attempt, 1)
    path = shorten(found, space, seed, problem.deadline)
    stuck: list[Array] = []
    for candidate in (path, found):
        mended = mend(candidate, space, problem.checker, seed, problem.deadline, stuck)
        if mended is not None:
            return mended
    return None


def check_start(problem: PlanningProblem) -> None:
    """Raise an error if no path can begin at the start.

    Raises:
        PlanningError: START_STATE_IN_COLLISION or START_STATE_VIOLATES_PATH_CONSTRAINTS.
    """
    if not problem.checker.is_free(problem.start):
        contacts = problem.checker.contacts(problem.start)
        what = f": {contacts[0]}" if contacts else ""
        raise PlanningError(
            MoveItErrorCode.START_STATE_IN_COLLISION, f"the start is in collision{what}"
        )
    if problem.path is not None:
        violation = problem.path.violation(problem.start)
        if violation:
            raise PlanningError(
                MoveItErrorCode.START_STATE_VIOLATES_PATH_CONSTRAINTS,
                f"the start violates the path constraints: {violation}",
            )


def check_start_is_proved(problem: PlanningProblem) -> None:
    """Raise an error if no path from the start can be proved, so that nobody searches for one.

    Raises:
        PlanningError: START_STATE_IN_COLLISION: something is too close.
    """
    obstruction = problem.checker.prove(np.vstack([problem.start, problem.start]))
    if obstruction is not None:
        raise PlanningError(
            MoveItErrorCode.START_STATE_IN_COLLISION, f"the start is in collision: {obstruction}"
        )


def race(
    problem: PlanningProblem, space: Space, goals: Array, reach: float, number: int
) -> Iterator[tuple[int, Array]]:
    """Search with several streams of random numbers in turn; yield each path that is found.

    Args:
        problem: what is searched for.
        space: where.
        goals: the states that paths may end in, (g, n).
        reach: longest move of a tree, in the joints' units.
        number: how often this was done before; each time has streams of its own.

    Yields:
        The number of the attempt and its path. An attempt that takes much longer than the first
        to succeed is given up.

    Raises:
        PlanningError: TIMED_OUT.
    """
    searches = {
        attempt: rrt_connect(space, problem.start, goals, (problem.seed, attempt), reach)
        for attempt in range(number * problem.attempts, (number + 1) * problem.attempts)
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
