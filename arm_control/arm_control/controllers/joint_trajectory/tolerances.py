"""Tolerances: how far the joints may be from their set-points."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.goals import GoalRequest, JointTolerance
from arm_control.controllers.joint_trajectory.plans import (
    ACCELERATION,
    POSITION,
    QUANTITIES,
    VELOCITY,
)
from arm_control.errors import ArmControlError

CHECKED_ROWS = 3
"""Position, velocity and acceleration; there is no tolerance for efforts."""

DISABLED = -1.0
"""In a goal: no tolerance, regardless of the controller's."""

Array = NDArray[np.float64]


class ToleranceError(ArmControlError):
    """A goal's tolerance cannot be used; the message says which."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """The largest allowed errors, as absolute values.

    Attributes:
        values: for position, velocity and acceleration, shape (3, n); infinite for no bound.
        is_any: whether there is any bound.
    """

    values: NDArray[np.float64]
    is_any: bool

    @classmethod
    def of(cls, tolerances: Array) -> "Bounds":
        """Make bounds from tolerances, shape (3, n), of which 0 or less means none."""
        values = np.where(tolerances > 0.0, tolerances, np.inf)
        return cls(values, bool(np.isfinite(values).any()))

    def hold(self, error: Array) -> bool:
        """Return whether errors, shape (k, n) with k <= 3, are within bounds; NaN never is."""
        return not self.is_any or not self._is_outside(error).any()

    def excess(self, error: Array, joints: Sequence[str]) -> str:
        """Return which error is out of bounds, as a message; there must be one."""
        row, joint = np.argwhere(self._is_outside(error))[0]
        return (
            f"{QUANTITIES[row]} error of joint {joints[joint]} is {error[row, joint]:f}, "
            f"tolerance {self.values[row, joint]:f}"
        )

    def _is_outside(self, error: Array) -> NDArray[np.bool_]:
        bounds = self.values[: len(error)]
        # Not `error > bounds`: a comparison with NaN is false, so NaN would pass.
        return np.isfinite(bounds) & ~(np.abs(error) <= bounds)


@dataclass(frozen=True, slots=True)
class Tolerances:
    """The tolerances that are checked while a trajectory is executed.

    Attributes:
        path: bounds along the path.
        goal: bounds at the end.
        goal_time_s: how late `goal` may be met; 0 for any time.
    """

    path: Bounds
    goal: Bounds
    goal_time_s: float

    @classmethod
    def of(
        cls, path: Array, goal: Array, stopped_velocity: float, goal_time_s: float
    ) -> "Tolerances":
        """Make tolerances from the controller's parameters.

        Args:
            path: position tolerances along the path, shape (n,).
            goal: position tolerances at the end, shape (n,).
            stopped_velocity: velocity tolerance of every joint at the end.
            goal_time_s: how late the goal may be reached.
        """
        on_the_way, at_end = np.zeros((2, CHECKED_ROWS, len(path)))
        on_the_way[POSITION] = path
        at_end[POSITION] = goal
        at_end[VELOCITY] = stopped_velocity
        return cls(Bounds.of(on_the_way), Bounds.of(at_end), goal_time_s)

    def switched_off(self) -> "Tolerances":
        """Return tolerances of the same joints without any bound."""
        off = Bounds.of(np.zeros_like(self.path.values))
        return Tolerances(off, off, 0.0)

    def for_goal(self, goal: GoalRequest, joints: Sequence[str]) -> "Tolerances":
        """Return these tolerances, overridden by a goal's.

        Raises:
            ToleranceError: the goal has a negative tolerance other than -1, or names an unknown
                joint.
        """
        return replace(
            self,
            path=_overridden(self.path, goal.path_tolerance, joints),
            goal=_overridden(self.goal, goal.goal_tolerance, joints),
            goal_time_s=_resolve(
                self.goal_time_s, goal.goal_time_tolerance_s, 0.0, "goal_time_tolerance"
            ),
        )


def _overridden(
    bounds: Bounds, tolerances: Iterable[JointTolerance], joints: Sequence[str]
) -> Bounds:
    values = bounds.values.copy()
    for tolerance in tolerances:
        if tolerance.name not in joints:
            raise ToleranceError(
                f"there is no joint '{tolerance.name}'; the joints are {', '.join(joints)}"
            )
        column = joints.index(tolerance.name)
        for row, asked in (
            (POSITION, tolerance.position),
            (VELOCITY, tolerance.velocity),
            (ACCELERATION, tolerance.acceleration),
        ):
            what = f"the {QUANTITIES[row]} tolerance of joint '{tolerance.name}'"
            values[row, column] = _resolve(values[row, column], asked, np.inf, what)
    return Bounds(values, bool(np.isfinite(values).any()))


def _resolve(default: float, asked: float, off: float, what: str) -> float:
    if asked == 0.0:
        return default
    if asked > 0.0:
        return asked
    if asked == DISABLED:
        return off
    raise ToleranceError(
        f"{what} is {asked:f}; it may be positive, 0 for the default or -1 for none"
    )
