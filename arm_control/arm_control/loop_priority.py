"""The real-time scheduler for a loop that sleeps most of the time."""

import logging
import os
import time
from collections.abc import Callable

MOST_DEMAND = 0.5
"""Share of a processor that the loop may need and still go before everybody else."""

logger = logging.getLogger(__name__)

Schedule = Callable[[int, int], None]


def schedule_this_thread(policy: int, priority: int) -> None:
    """Set the scheduler of the calling thread; what it starts runs as ordinary threads do.

    Raises:
        OSError: the process lacks the right.
    """
    os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, os.sched_param(priority))


class LoopPriority:
    """Lets the loop thread go before all others while it leaves them at least half a processor.

    On busy processors a thread of ordinary priority wakes some milliseconds late, which is several
    periods of a fast loop. With SCHED_FIFO it wakes in time, but one that never sleeps would keep
    a processor from everybody. So once a second the processor time that the loop took is held
    against the time its ticks had: a loop as fast as possible, steps of a paused one and physics
    too slow for real time run at ordinary priority.

    Every method belongs to the loop thread.
    """

    def __init__(
        self,
        priority: int,
        *,
        insist: bool = False,
        schedule: Schedule = schedule_this_thread,
        now_s: Callable[[], float] = time.monotonic,
        used_s: Callable[[], float] = time.thread_time,
    ) -> None:
        """Start at ordinary priority.

        Args:
            priority: of SCHED_FIFO, 1 to 99; 0 leaves the ordinary scheduler.
            insist: whether to warn where the process lacks the right.
            schedule: sets the thread's policy and priority.
            now_s: wall time.
            used_s: processor time of the calling thread.
        """
        self._priority = priority
        self._insist = insist
        self._schedule = schedule
        self._now_s = now_s
        self._used_s = used_s
        self._raised = False
        self._begin()

    def lower(self) -> None:
        """Go on at ordinary priority; the next second is measured anew."""
        if self._raised:
            self._set(os.SCHED_OTHER, 0)
        self._begin()

    def note(self, period_s: float, planned_s: float) -> None:
        """Note a tick; when those of a second are done, choose the scheduler for the next.

        Args:
            period_s: ticked time that a tick advances.
            planned_s: wall time that it may take; 0 as fast as possible.
        """
        self._ticked_s += period_s
        self._planned_s += planned_s
        if self._ticked_s < 1.0:
            return
        available_s = min(self._planned_s, self._now_s() - self._began_s)
        modest = self._used_s() - self._used_before_s < MOST_DEMAND * available_s
        if not modest:
            self.lower()
            return
        if self._priority and not self._raised:
            self._set(os.SCHED_FIFO, self._priority)
        self._begin()

    def _begin(self) -> None:
        self._ticked_s = self._planned_s = 0.0
        self._began_s = self._now_s()
        self._used_before_s = self._used_s()

    def _set(self, policy: int, priority: int) -> None:
        try:
            self._schedule(policy, priority)
        except OSError as error:
            logger.log(
                logging.WARNING if self._insist else logging.DEBUG,
                "the control loop runs without SCHED_FIFO priority %d: %s",
                self._priority,
                error.strerror,
            )
            self._priority = 0
        else:
            self._raised = policy == os.SCHED_FIFO
