"""What a planner gets and what it gives: a problem of joint positions, without links or frames."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from arm_planning.constraints.evaluation import ConstraintEvaluator
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.robot.model import JointGroup

Array = NDArray[np.float64]


class PathObstruction(Protocol):
    """Where a path could not be proved free; as text, the end of a sentence."""

    @property
    def segment(self) -> int:
        """Index of the way point before it; all segments before that are free."""
        ...

    @property
    def fraction(self) -> float:
        """Where on the segment, 0 to 1."""
        ...

    @property
    def away(self) -> Array | None:
        """Direction from there, (n,), in which it is free soonest; None if nobody knows."""
        ...


class StateChecker(Protocol):
    """Says what is free of collisions; for one thread at a time."""

    def is_free(self, q: Array) -> bool:
        """Return whether the robot is free at positions of the group, (n,)."""
        ...

    def free_count(self, states: Array, clearance_m: float = 0.0) -> int:
        """Return how many states, (k, n), are free before the first that is not.

        With a clearance, what is nearer than that is not free.
        """
        ...

    def is_free_edge(self, a: Array, b: Array) -> bool:
        """Return whether all states on the straight line between two are free, ends included."""
        ...

    def prove(self, path: Array) -> PathObstruction | None:
        """Return None if every state on a polyline, (m, n), is proved free."""
        ...

    def contacts(self, q: Array) -> Sequence[object]:
        """Return what touches at positions of the group; each is the end of a sentence."""
        ...


def never() -> bool:
    """Return False: nobody interrupts."""
    return False


@dataclass(frozen=True, slots=True)
class Deadline:
    """A time by which an answer is due, unless nobody wants it any more.

    Attributes:
        end_s: the time, on the clock.
        clock: returns the present time in s.
        interrupted: tells when the answer is not wanted any more; any thread may make it true.
    """

    end_s: float = math.inf
    clock: Callable[[], float] = time.monotonic
    interrupted: Callable[[], bool] = never

    @classmethod
    def after(cls, duration_s: float, interrupted: Callable[[], bool] = never) -> "Deadline":
        """Return the deadline that is so many seconds from now."""
        return cls(time.monotonic() + duration_s, interrupted=interrupted)

    def check(self, doing: str) -> None:
        """Raise an error after the deadline, or once it is interrupted.

        Raises:
            PlanningError: TIMED_OUT or PREEMPTED; the message says what was being done.
        """
        if self.interrupted():
            raise PlanningError(
                MoveItErrorCode.PREEMPTED, f"planning was interrupted while {doing}"
            )
        if self.clock() > self.end_s:
            raise PlanningError(
                MoveItErrorCode.TIMED_OUT, f"the planning time ended while {doing}; allow more time"
            )


NO_DEADLINE = Deadline()


class GoalSource(Protocol):
    """Gives states that reach the goal; the same ones each time."""

    def nearest(self) -> tuple[Array, ...]:
        """Return the goal states that are cheap to find, those near the start first.

        Raises:
            PlanningError: there is none; the message says why.
        """
        ...

    def all(self) -> tuple[Array, ...]:
        """Return different goal states to choose from, those near the start first.

        Raises:
            PlanningError: there is none; the message says why.
        """
        ...


@dataclass(frozen=True, slots=True, eq=False)
class PlanningProblem:
    """A path to find.

    Attributes:
        group: the joints; all arrays follow their order.
        start: a free state within the limits, (n,).
        goals: where the path may end.
        checker: what is free.
        path: what holds on the whole way, if anything.
        deadline: when the answer is due. It only ends a search: it never changes a path.
        seed: the same problem with the same seed has the same answer.
        attempts: searches with different random numbers; the shortest path counts.
    """

    group: JointGroup
    start: Array
    goals: GoalSource
    checker: StateChecker
    path: ConstraintEvaluator | None = None
    deadline: Deadline = NO_DEADLINE
    seed: int = 0
    attempts: int = 1


class PathPlanner(Protocol):
    """A way to find paths."""

    def plan(self, problem: PlanningProblem) -> Array:
        """Return a path from the start to a goal, (m, n), m at least 2; every state is free.

        Raises:
            PlanningError: there is no goal state, no path was found, or the time ended.
        """
        ...


def length(change: Array) -> float:
    """Return the Euclidean length of a change of joints, (n,); faster than NumPy's own."""
    return math.sqrt(change.dot(change))


def path_length(path: Array) -> float:
    """Return the length of a polyline, (m, n), in the joints' units."""
    sides = path[1:] - path[:-1]
    return float(np.sqrt(np.einsum("ij,ij->i", sides, sides)).sum())
