"""When the next tick is due, and how well the past ones kept their time."""

import logging
from dataclasses import dataclass
from math import nan

from arm_control.clock import Clock, MonotonicClock
from arm_control.run_record import RunRecord

CATCH_UP_S = 0.05
"""A stall up to this long is made up for; of a longer one the rest is given up."""

WINDOW_S = 1.0
STATISTICS_S = 5.0
WARNING_INTERVAL_S = 10.0
KEPT = 0.99
"""Share of the pace from which on a stall is told as one, not as a pace that is not kept."""


@dataclass(frozen=True, slots=True)
class PacerStatistics:
    """How a pacer has done so far, in wall time.

    Attributes:
        ticks: number of ticks.
        overruns: ticks that were not finished when the next one was due.
        lag_s: how late the last tick started.
        max_lag_s: how late the latest one ever started.
        lost_s: time given up because a stall was longer than the catch-up cap.
        achieved_factor: time ticked over wall time in the last full second; 0.0 before that.
    """

    ticks: int = 0
    overruns: int = 0
    lag_s: float = 0.0
    max_lag_s: float = 0.0
    lost_s: float = 0.0
    achieved_factor: float = 0.0


class Pacer:
    """Sets absolute deadlines for ticks: period / real_time_factor apart, without drift.

    After a stall the ticks that were missed follow one another without a wait, up to
    `catch_up_s` of wall time; what is beyond is given up and counted. Loop thread only, except
    `statistics`, `runs` and `remaining_s`, which any thread may read.

    Attributes:
        period_s: time that one tick advances, in seconds of the ticked time.
        wall_period_s: wall time from one tick to the next; 0 as fast as possible.
        print_warnings: whether it says in the log that ticks come too late.
        runs: the latest ticks, in wall time.
    """

    def __init__(
        self,
        period_s: float,
        *,
        real_time_factor: float = 1.0,
        clock: Clock | None = None,
        catch_up_s: float = CATCH_UP_S,
        print_warnings: bool = True,
    ) -> None:
        """Make a pacer whose first tick is due at once.

        Args:
            period_s: time that one tick advances, in seconds of the ticked time.
            real_time_factor: ticked over wall time; 0 runs as fast as possible.
            clock: wall time; default the operating system's monotonic clock.
            catch_up_s: longest stall that is made up for.
            print_warnings: whether to say in the log that ticks come too late.
        """
        if not period_s > 0.0:
            raise ValueError(f"the period must be positive, not {period_s!r} s")
        self.period_s = period_s
        self.print_warnings = print_warnings
        self.runs = RunRecord(max(2, round(STATISTICS_S / period_s)))
        self._catch_up_s = catch_up_s
        self._now_s = (clock or MonotonicClock()).now_s
        self._ticks = self._overruns = 0
        self._lag_s = self._max_lag_s = self._lost_s = self._achieved_factor = 0.0
        self._warned_s = -WARNING_INTERVAL_S
        self.real_time_factor = real_time_factor

    @property
    def real_time_factor(self) -> float:
        """Ticked over wall time; 0 runs as fast as possible."""
        return self._real_time_factor

    @real_time_factor.setter
    def real_time_factor(self, factor: float) -> None:
        if not 0.0 <= factor < float("inf"):
            raise ValueError(
                f"real_time_factor must be 0 (as fast as possible) or positive, not {factor!r}"
            )
        self._real_time_factor = factor
        self.wall_period_s = self.period_s / factor if factor else 0.0
        self.restart()

    @property
    def statistics(self) -> PacerStatistics:
        """A snapshot of how it went so far."""
        return PacerStatistics(
            self._ticks,
            self._overruns,
            self._lag_s,
            self._max_lag_s,
            self._lost_s,
            self._achieved_factor,
        )

    def restart(self) -> None:
        """Forget the deadlines, for example after a pause: the next tick is due now."""
        self._due_s = self._window_start_s = self._began_s = self._now_s()
        self._last_began_s = nan
        self._window_ticks = 0
        self._forget_unsaid(self._due_s)
        self.runs.clear()

    def remaining_s(self) -> float:
        """Return how long the next tick is still to wait; 0 or less when it is due."""
        return self._due_s - self._now_s() if self.wall_period_s else 0.0

    def begin(self) -> None:
        """Note that a tick starts, and set the deadline of the next one."""
        self._began_s = now_s = self._now_s()
        if not self.wall_period_s:
            return
        self._lag_s = lag_s = max(0.0, now_s - self._due_s)
        if lag_s > self._unsaid_max_lag_s:
            self._unsaid_max_lag_s = lag_s
            self._max_lag_s = max(self._max_lag_s, lag_s)
        if lag_s > self._catch_up_s:
            self._unsaid_lost_s += lag_s - self._catch_up_s
            self._lost_s += lag_s - self._catch_up_s
            self._due_s = now_s - self._catch_up_s
        self._due_s += self.wall_period_s

    def end(self) -> None:
        """Note that the tick is done."""
        now_s = self._now_s()
        self.runs.add(self._began_s - self._last_began_s, now_s - self._began_s)
        self._last_began_s = self._began_s
        self._ticks += 1
        self._window_ticks += 1
        if self.wall_period_s and now_s > self._due_s:
            self._overruns += 1
            self._unsaid_overruns += 1
        if now_s - self._window_start_s >= WINDOW_S:
            self._close_window(now_s)

    def _close_window(self, now_s: float) -> None:
        elapsed_s = now_s - self._window_start_s
        self._achieved_factor = self._window_ticks * self.period_s / elapsed_s
        self._unsaid_ticks += self._window_ticks
        self._window_start_s, self._window_ticks = now_s, 0
        if self._unsaid_lost_s:
            if now_s - self._warned_s < WARNING_INTERVAL_S:
                return  # Said with what comes until then: nothing that is given up goes unsaid.
            self._warned_s = now_s
            if self.print_warnings:
                self._warn(now_s - self._unsaid_since_s)
        elif self.wall_period_s and now_s - self._due_s > self._catch_up_s:
            return  # What the next tick gives up has been lost in this window.
        self._forget_unsaid(now_s)

    def _warn(self, elapsed_s: float) -> None:
        logger = logging.getLogger(__name__)
        achieved = self._unsaid_ticks * self.period_s / elapsed_s
        latest_ms = 1e3 * self._unsaid_max_lag_s
        if achieved >= KEPT * self._real_time_factor:
            logger.warning(
                "the control loop was held up: a tick started %.1f ms after its time, "
                "%.3f s given up",
                latest_ms,
                self._unsaid_lost_s,
            )
            return
        logger.warning(
            "the control loop cannot keep its pace: real-time factor %.2f instead of %g, "
            "%d of %d ticks overran, latest start %.1f ms after its time, %.3f s given up",
            achieved,
            self._real_time_factor,
            self._unsaid_overruns,
            self._unsaid_ticks,
            latest_ms,
            self._unsaid_lost_s,
        )

    def _forget_unsaid(self, now_s: float) -> None:
        self._unsaid_since_s = now_s
        self._unsaid_ticks = self._unsaid_overruns = 0
        self._unsaid_lost_s = self._unsaid_max_lag_s = 0.0
