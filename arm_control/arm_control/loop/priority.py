"""Gives the loop thread a real-time priority as long as it sleeps most of the time."""

import logging
import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress

MAX_LOAD = 0.5
"""Fraction of a processor above which the loop loses its real-time priority."""

OTHERS_NICENESS = -20
"""Niceness of the other threads while the loop has real-time priority: eighty ordinary shares."""

logger = logging.getLogger("controller_manager")

Schedule = Callable[[int, int], None]


def schedule_this_thread(policy: int, priority: int) -> None:
    """Set the scheduler of the calling thread; threads that it starts get the ordinary one.

    Raises:
        OSError: the process lacks the right.
    """
    os.sched_setscheduler(0, policy | os.SCHED_RESET_ON_FORK, os.sched_param(priority))


def renice_other_threads(niceness: int) -> None:
    """Change the niceness of all threads of the process except the calling one.

    Threads that they start later inherit it. Threads that have ended meanwhile are skipped.

    Raises:
        OSError: the process lacks the right.
    """
    own = threading.get_native_id()
    for thread in map(int, os.listdir("/proc/self/task")):
        if thread != own:
            with suppress(ProcessLookupError):
                present = os.getpriority(os.PRIO_PROCESS, thread)
                os.setpriority(os.PRIO_PROCESS, thread, present + niceness)


class LoopPriority:
    """Raises the loop thread's priority while the loop uses less than half a processor.

    On busy processors a thread of ordinary priority wakes some milliseconds late, which is several
    periods of a fast loop. With SCHED_FIFO it wakes in time, but a thread that never sleeps would
    occupy a processor alone. So once a second the loop's processor time is compared with the time
    that its ticks had. A loop that runs as fast as possible, a paused loop that is stepped, and
    physics too slow for real time run at ordinary priority.

    The loop shares locks with the other threads of its process: Python's interpreter lock and the
    locks of the middleware. A thread that holds one and waits for a processor delays the loop too,
    whatever the loop's priority is. So while the loop's priority is raised, these threads get a
    larger share of the processors than other processes.

    Loop thread only.
    """

    def __init__(
        self,
        priority: int,
        *,
        warn_if_denied: bool = False,
        schedule: Schedule = schedule_this_thread,
        renice_others: Callable[[int], None] = renice_other_threads,
        now_s: Callable[[], float] = time.monotonic,
        used_s: Callable[[], float] = time.thread_time,
    ) -> None:
        """Start at ordinary priority.

        Args:
            priority: SCHED_FIFO priority, 1 to 99; 0 keeps the ordinary scheduler.
            warn_if_denied: whether to warn if the process lacks the right.
            schedule: sets the thread's policy and priority.
            renice_others: changes the niceness of the process's other threads by a number.
            now_s: wall time.
            used_s: processor time of the calling thread.
        """
        self._priority = priority
        self._warn_if_denied = warn_if_denied
        self._schedule = schedule
        self._renice_others = renice_others
        self._now_s = now_s
        self._used_s = used_s
        self._raised = False
        self._begin()

    def lower(self) -> None:
        """Return to ordinary priority and start a new measurement."""
        if self._raised:
            self._set(os.SCHED_OTHER, 0)
        self._begin()

    def note(self, period_s: float, planned_s: float) -> None:
        """Record a tick; after each second of ticks, choose the scheduler for the next second.

        Args:
            period_s: time that the tick advances, in seconds of the loop's time.
            planned_s: wall time that it may take; 0 for as fast as possible.
        """
        self._ticked_s += period_s
        self._planned_s += planned_s
        if self._ticked_s < 1.0:
            return
        available_s = min(self._planned_s, self._now_s() - self._began_s)
        is_light = self._used_s() - self._used_before_s < MAX_LOAD * available_s
        if not is_light:
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
                logging.WARNING if self._warn_if_denied else logging.DEBUG,
                "the control loop runs without SCHED_FIFO priority %d: %s",
                self._priority,
                error.strerror,
            )
            self._priority = 0
        else:
            self._raised = policy == os.SCHED_FIFO
            # A process whose rtprio limit allows SCHED_FIFO may still lack the right to this.
            with suppress(OSError):
                self._renice_others(OTHERS_NICENESS if self._raised else -OTHERS_NICENESS)
