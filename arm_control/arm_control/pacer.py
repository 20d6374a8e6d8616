"""When the next tick is due, and how well the past ones kept their time."""

import logging
from dataclasses import dataclass

from arm_control.clock import Clock

CATCH_UP_S = 0.05
"""A stall up to this long is made up for; of a longer one the rest is given up."""

WARNING_INTERVAL_S = 10.0


@dataclass(frozen=True, slots=True)
class PacerStatistics:
    """How a pacer has done since it was made.

    Attributes:
        ticks: number of ticks.
        overruns: ticks that were not finished when the next was due.
        lag_s: how late the last tick started.
        max_lag_s: how late the latest tick ever started.
        lost_s: wall time given up because stalls were longer than the catch-up cap.
        achieved_factor: simulated over wall time in the last full second or so; 0 before that.
    """

    ticks: int = 0
    overruns: int = 0
    lag_s: float = 0.0
    max_lag_s: float = 0.0
    lost_s: float = 0.0
    achieved_factor: float = 0.0
