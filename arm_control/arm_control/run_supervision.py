"""How runs of outside code are measured, and what becomes of what they raise."""

from collections.abc import Callable
from dataclasses import dataclass

from arm_control.clock import MonotonicClock
from arm_control.guarded import FailureHandler, log_failure
from arm_control.run_record import RunRecord


@dataclass(frozen=True, slots=True)
class RunSupervision:
    """What the runs of controllers and components have in common.

    Attributes:
        samples: how many of the latest runs the statistics speak of.
        now_s: wall time for execution times.
        on_exception: gets what a run raised; returns where the manager is to go on.
    """

    samples: int = 500
    now_s: Callable[[], float] = MonotonicClock.now_s
    on_exception: FailureHandler = log_failure

    def record(self) -> RunRecord:
        """Make a record for something that runs."""
        return RunRecord(self.samples)
