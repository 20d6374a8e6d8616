"""Sees whether a joint is at its goal, on its way, or stuck."""

from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """How a goal is doing."""

    UNDER_WAY = "under way"
    REACHED = "reached"
    STALLED = "stalled"


@dataclass(slots=True)
class GoalWatch:
    """Judges one goal in every cycle. Loop thread only.

    Attributes:
        tolerance: a joint nearer to its goal than this is there, in rad or m.
        still_velocity: a joint no faster than this stands still, in rad/s or m/s.
        stall_timeout_s: a joint that stands still for longer is stuck.
        still_s: for how long it has stood still.
    """

    tolerance: float
    still_velocity: float
    stall_timeout_s: float
    still_s: float = 0.0

    def judge(self, error: float, velocity: float, period_s: float) -> Verdict:
        """Return how the goal is doing after a period; velocities that are NaN count as motion.

        Args:
            error: distance to the goal, of either sign.
            velocity: measured now.
            period_s: since the last call, or since the goal came.
        """
        if abs(error) < self.tolerance:
            return Verdict.REACHED
        # Periods are added up instead of comparing times: a clock that is set back does no harm.
        self.still_s = self.still_s + period_s if abs(velocity) <= self.still_velocity else 0.0
        return Verdict.STALLED if self.still_s > self.stall_timeout_s else Verdict.UNDER_WAY
