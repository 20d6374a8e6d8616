"""A plan on its way."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.motion import RESOLUTION_S
from arm_control.joint_trajectory.plans import Plan
from arm_control.joint_trajectory.state import Progress
from arm_control.joint_trajectory.tolerances import Tolerances


class Verdict(Enum):
    """How an execution is doing."""

    UNDER_WAY = "under way"
    OFF_THE_PATH = "off the path"
    AT_THE_GOAL = "at the goal"
    NOT_THERE_YET = "not there yet"
    TOO_LATE = "too late"


@dataclass(slots=True)
class Execution:
    """A plan, and how far it has got. Loop thread only.

    Attributes:
        plan: what to do.
        tolerances: what to check meanwhile.
        serves_goal: whether a goal ends with it.
        is_stop: whether it only brings the joints to rest: in real time, without a time-out.
        lead_s: how long after its own start the plan's trajectory begins; negative where the
            trajectory should have begun before.
        elapsed_s: the plan's time.
        age_s: the controller's time since the plan's start: ahead of `elapsed_s` where the speed
            is scaled down.
        is_first: whether this is its first cycle.
    """

    plan: Plan
    tolerances: Tolerances
    serves_goal: bool = False
    is_stop: bool = False
    lead_s: float = 0.0
    elapsed_s: float = 0.0
    age_s: float = 0.0
    is_first: bool = True

    def advance(self, period_s: float, speed_scaling: float) -> None:
        """Let a period pass."""
        self.elapsed_s = self.elapsed_after(period_s, speed_scaling)
        self.age_s += period_s
        self.is_first = False

    def elapsed_after(self, period_s: float, speed_scaling: float) -> float:
        """Return the plan's time when a period will have passed."""
        return self.elapsed_s + (period_s if self.is_stop else period_s * speed_scaling)

    @property
    def progress(self) -> Progress:
        """How far it has got, in times since the start of its trajectory."""
        return Progress(self.elapsed_s - self.lead_s, self.age_s - self.lead_s)

    @property
    def late_s(self) -> float:
        """Time since the end of the plan; negative before it."""
        return self.elapsed_s - self.plan.end_s

    def judge(self, error: NDArray[np.float64]) -> Verdict:
        """Compare errors with the tolerances.

        Args:
            error: of position and, where they count, velocity and acceleration; shape (k, n).
        """
        late_s = self.late_s
        has_ended = late_s >= -RESOLUTION_S
        # A plan may have ended before it began; then the way there is checked for once.
        if (self.is_first or not has_ended) and not self.tolerances.path.hold(error):
            return Verdict.OFF_THE_PATH
        if not has_ended:
            return Verdict.UNDER_WAY
        if self.tolerances.goal.hold(error):
            return Verdict.AT_THE_GOAL
        if 0.0 < self.tolerances.goal_time_s < late_s - RESOLUTION_S:
            return Verdict.TOO_LATE
        return Verdict.NOT_THERE_YET

    def settle(self) -> None:
        """Stay at the end for good: no goal waits, nothing is checked any more."""
        self.serves_goal = False
        self.tolerances = self.tolerances.switched_off()
        self.is_stop = True
