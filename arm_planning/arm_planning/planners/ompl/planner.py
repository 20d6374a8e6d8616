"""Runs a planner of OMPL on a planning problem.

OMPL moves only along edges that the checker has proved. Its random numbers start from the seed, and
its work is counted in edges: the same problem with the same seed has the same answer.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import MissingOmplError, NoPlanError, PlanningError
from arm_planning.planners.problem import PlanningProblem, StateChecker, path_length
from arm_planning.planners.search import (
    check_start,
    check_start_is_proved,
    shortened_and_proved,
    straight_to_any,
)
from arm_planning.planners.space import space_of

try:
    import ompl.base
    import ompl.geometric
    import ompl.util
except ImportError as error:
    raise MissingOmplError() from error

Array = NDArray[np.float64]

EDGES = 2000
"""Edges that a planner checks which goes on improving its path."""
CALLS = 1_000_000
"""How often a planner asks whether to end, at most: one that checks no more edges would never."""
UNDETERMINED = frozenset({"PRM", "PRMstar"})
"""Planners that look for the path in a thread of their own: its timing changes the answer."""


def planner_names() -> tuple[str, ...]:
    """Return the names of the planners that the wheel has and whose answers repeat."""
    found = vars(ompl.geometric).items()
    return tuple(
        sorted(
            name
            for name, value in found
            if isinstance(value, type)
            and issubclass(value, ompl.base.Planner)
            and name not in UNDETERMINED
        )
    )


def takes_range(name: str) -> bool:
    """Return whether a planner's moves can be limited."""
    return hasattr(getattr(ompl.geometric, name), "setRange")


def takes_goal_bias(name: str) -> bool:
    """Return whether a planner samples goals at a rate that can be set."""
    return hasattr(getattr(ompl.geometric, name), "setGoalBias")


State = Any
"""A state of OMPL's real vector space, whose stubs do not know that its slices are its numbers."""


@dataclass(frozen=True, slots=True)
class OmplPlanner:
    """Plans with a planner of OMPL.

    Attributes:
        name: one of `planner_names`.
        parameters: "range" and "goal_bias", where the planner takes them; a range of 0 is OMPL's.
    """

    name: str
    parameters: Mapping[str, float] = field(default_factory=dict)

    def plan(self, problem: PlanningProblem) -> Array:
        """Return a proved path, (m, n); see `PathPlanner`.

        Raises:
            PlanningError: also if the problem has path constraints.
        """
        if problem.path is not None and problem.path.constraints:
            raise NoPlanError(
                f"OMPL's {self.name} takes no path constraints; the planner RRTConnect does"
            )
        check_start(problem)
        path, goals = straight_to_any(problem)
        if path is not None:
            return path
        check_start_is_proved(problem)
        found = (
            self._search(problem, goals, problem.seed + attempt)
            for attempt in range(problem.attempts)
        )
        space = space_of(problem, goals)
        paths = (
            shortened_and_proved(problem, space, path, attempt)
            for attempt, path in enumerate(found)
        )
        proved = [path for path in paths if path is not None]
        if not proved:
            raise NoPlanError(f"OMPL's {self.name} found no path that is proved free")
        return min(proved, key=path_length)

    def _search(self, problem: PlanningProblem, goals: Array, seed: int) -> Array:
        ompl.util.noOutputHandler()
        # OMPL reports an error if random numbers were drawn before, but generators made from here
        # on do start from this seed. 0 means none there.
        ompl.util.RNG.setSeed(1 + seed % (2**31 - 1))
        bounds = space_of(problem, goals)
        space = _state_space(bounds.lower, bounds.upper)
        setup = ompl.geometric.SimpleSetup(space)
        information = setup.getSpaceInformation()
        guard = _Guard(problem, len(problem.start))
        is_free: Any = guard.is_free
        setup.setStateValidityChecker(is_free)
        information.setMotionValidator(_EdgeValidator(information, guard))
        setup.setStartState(_state(space, problem.start))
        goal_states = ompl.base.GoalStates(information)
        for goal in goals:
            goal_states.addState(_state(space, goal))
        setup.setGoal(goal_states)
        planner = getattr(ompl.geometric, self.name)(information)
        # A range of 0 lets OMPL choose, as before anything is set.
        if reach := self.parameters.get("range", 0.0):
            planner.setRange(reach)
        if "goal_bias" in self.parameters:
            planner.setGoalBias(self.parameters["goal_bias"])
        setup.setPlanner(planner)
        setup.solve(ompl.base.PlannerTerminationCondition(guard.ends))
        guard.raise_error()
        if not setup.haveExactSolutionPath():
            raise NoPlanError(f"OMPL's {self.name} found no path to the goal")
        solution = setup.getSolutionPath()
        states: list[State] = [
            solution.getState(index) for index in range(solution.getStateCount())
        ]
        return np.array([state[0 : len(problem.start)] for state in states])


@dataclass(slots=True, eq=False)
class _Guard:
    """Answers OMPL's questions; an error ends the search, because C++ must not see it."""

    problem: PlanningProblem
    joints: int
    edges: int = 0
    calls: int = 0
    error: Exception | None = field(default=None)

    @property
    def checker(self) -> StateChecker:
        return self.problem.checker

    def raise_error(self) -> None:
        """Raise the error that ended the search, if any.

        The error's frames hold OMPL's objects, which hold this: it lets go, or they would stay.
        """
        error, self.error = self.error, None
        if error is not None:
            raise error.with_traceback(None)

    def is_free(self, state: State) -> bool:
        try:
            return self.checker.is_free(np.array(state[0 : self.joints]))
        except Exception as error:
            self.error = error
            return False

    def is_free_edge(self, a: State, b: State) -> bool:
        self.edges += 1
        try:
            first, second = np.array(a[0 : self.joints]), np.array(b[0 : self.joints])
            return self.checker.is_free_edge(first, second)
        except Exception as error:
            self.error = error
            return False

    def ends(self) -> bool:
        self.calls += 1
        if self.error is None:
            try:
                self.problem.deadline.check("searching for a path")
            except PlanningError as error:
                self.error = error
        return self.error is not None or self.edges >= EDGES or self.calls >= CALLS


class _EdgeValidator(ompl.base.MotionValidator):
    """Asks the checker about edges, in place of OMPL's samples of them."""

    def __init__(self, information: "ompl.base.SpaceInformation", guard: _Guard) -> None:
        super().__init__(information)
        self._guard = guard

    def checkMotion(self, a: State, b: State, *last: object) -> bool:
        # The planners of this wheel never ask for the last valid state, `last`.
        return self._guard.is_free_edge(a, b)


def _state_space(lower: Array, upper: Array) -> "ompl.base.RealVectorStateSpace":
    space = ompl.base.RealVectorStateSpace(len(lower))
    bounds = ompl.base.RealVectorBounds(len(lower))
    for index, (low, high) in enumerate(zip(lower.tolist(), upper.tolist(), strict=True)):
        # A joint without any range is one that does not move.
        bounds.setLow(index, low)
        bounds.setHigh(index, high if high > low else math.nextafter(low, math.inf))
    space.setBounds(bounds)
    return space


def _state(space: "ompl.base.RealVectorStateSpace", q: Array) -> State:
    state: State = space.allocState()
    state[0 : len(q)] = q.tolist()
    return state
