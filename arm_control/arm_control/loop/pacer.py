"""Decides when the next tick is due, and measures how punctual the past ones were."""

import logging
from math import nan

from arm_control.loop.clock import Clock, MonotonicClock
from arm_control.loop.supervision import RunRecord
from arm_node.frozen import frozen

CATCH_UP_S = 0.05
"""Delays up to this long are caught up; the rest of a longer delay is given up."""

WINDOW_S = 1.0
STATISTICS_S = 5.0
WARNING_INTERVAL_S = 10.0
KEPT = 0.99
"""From this fraction of the pace on, lost time is reported as a stall, not as a slow loop."""


@frozen
class PacerStatistics:
    """How punctual a pacer's ticks have been so far, in wall time.

    Attributes:
        ticks: number of ticks.
        overruns: ticks that were not finished when the next one was due.
        lag_s: how late the last tick started.
        max_lag_s: the greatest lag of any tick.
        lost_s: time given up because a stall was longer than the catch-up cap.
        achieved_factor: real-time factor in the last full second; 0.0 before that.
    """

    ticks: int = 0
    overruns: int = 0
    lag_s: float = 0.0
    max_lag_s: float = 0.0
    lost_s: float = 0.0
    achieved_factor: float = 0.0


class Pacer:
    """Sets absolute deadlines for ticks: period / real_time_factor apart, without drift.

    After a stall, the missed ticks run without a wait, up to `catch_up_s` of wall time; the rest is
    given up and counted. Loop thread only, except `statistics`, `runs` and `remaining_s`, which any
    thread may read.

    Attributes:
        period_s: time that one tick advances, in seconds of the loop's time.
        wall_period_s: wall time from one tick to the next; 0 for as fast as possible.
        print_warnings: whether late ticks are logged.
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
            period_s: time that one tick advances, in seconds of the loop's time.
            real_time_factor: the loop's time over wall time; 0 runs as fast as possible.
            clock: wall time; default the operating system's monotonic clock.
            catch_up_s: longest stall that is caught up.
            print_warnings: whether to log late ticks.
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
        """The loop's time over wall time; 0 runs as fast as possible."""
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
        """A snapshot of the statistics so far."""
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
        self._reset_unreported(self._due_s)
        self.runs.clear()

    def remaining_s(self) -> float:
        """Return the time until the next tick; 0 or less when it is due."""
        return self._due_s - self._now_s() if self.wall_period_s else 0.0

    def begin(self) -> None:
        """Note that a tick starts, and set the deadline of the next one."""
        self._began_s = now_s = self._now_s()
        if not self.wall_period_s:
            return
        self._lag_s = lag_s = max(0.0, now_s - self._due_s)
        if lag_s > self._unreported_max_lag_s:
            self._unreported_max_lag_s = lag_s
            self._max_lag_s = max(self._max_lag_s, lag_s)
        if lag_s > self._catch_up_s:
            self._unreported_lost_s += lag_s - self._catch_up_s
            self._lost_s += lag_s - self._catch_up_s
            self._due_s = now_s - self._catch_up_s
        self._due_s += self.wall_period_s

    def end(self) -> None:
        """Note that the tick is done."""
        now_s = self._now_s()
        self.runs.add_period(self._began_s - self._last_began_s)
        self.runs.add_duration(now_s - self._began_s)
        self._last_began_s = self._began_s
        self._ticks += 1
        self._window_ticks += 1
        if self.wall_period_s and now_s > self._due_s:
            self._overruns += 1
            self._unreported_overruns += 1
        if now_s - self._window_start_s >= WINDOW_S:
            self._close_window(now_s)

    def _close_window(self, now_s: float) -> None:
        elapsed_s = now_s - self._window_start_s
        self._achieved_factor = self._window_ticks * self.period_s / elapsed_s
        self._unreported_ticks += self._window_ticks
        self._window_start_s, self._window_ticks = now_s, 0
        if self._unreported_lost_s:
            if now_s - self._warned_s < WARNING_INTERVAL_S:
                return  # The next warning will include this loss.
            self._warned_s = now_s
            if self.print_warnings:
                self._warn(now_s - self._unreported_since_s)
        elif self.wall_period_s and now_s - self._due_s > self._catch_up_s:
            return  # The next tick will give up time that was lost in this window.
        self._reset_unreported(now_s)

    def _warn(self, elapsed_s: float) -> None:
        logger = logging.getLogger("controller_manager")
        achieved = self._unreported_ticks * self.period_s / elapsed_s
        latest_ms = 1e3 * self._unreported_max_lag_s
        if achieved >= KEPT * self._real_time_factor:
            logger.warning(
                "the control loop was held up: a tick started %.1f ms late, and %.3f s were "
                "given up",
                latest_ms,
                self._unreported_lost_s,
            )
            return
        logger.warning(
            "the control loop cannot keep its pace: real-time factor %.2f instead of %g, "
            "%d of %d ticks overran, the latest start was %.1f ms late, and %.3f s were given up",
            achieved,
            self._real_time_factor,
            self._unreported_overruns,
            self._unreported_ticks,
            latest_ms,
            self._unreported_lost_s,
        )

    def _reset_unreported(self, now_s: float) -> None:
        self._unreported_since_s = now_s
        self._unreported_ticks = self._unreported_overruns = 0
        self._unreported_lost_s = self._unreported_max_lag_s = 0.0
