"""Makes a participant that is discovered at once by those who wait for it.

A Fast DDS participant announces itself a moment before it starts to listen. Whoever has been
waiting answers within 0.3 ms, once; an answer that comes before the listening is thrown away,
and the two then do not know each other until the next periodic announcement, up to 3 s later.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from arm_node.signs_of_life import show_life_often


@contextmanager
def answers_held_back() -> Iterator[None]:
    """Keep answers to the first announcement in the sockets until this thread is through.

    Make the process's first node inside. Threads inherit the scheduling of the thread that makes
    them, so Fast DDS's receiving threads start on this thread's processor and cannot preempt it:
    they read what came in once this thread waits for something, and by then the participant
    listens. SCHED_RR, where the process may, keeps other processes from coming between;
    SCHED_BATCH needs no privilege. Not SCHED_FIFO: one of Fast DDS's threads may wait in a busy
    loop for this one, and would never let go of the processor. Afterwards all threads of the
    process run as before, and whoever sends to it finds it alive; see `signs_of_life`.
    """
    allowed = os.sched_getaffinity(0)
    confined = os.sched_getscheduler(0) == os.SCHED_OTHER and _confine()
    try:
        yield
    finally:
        if confined:
            for thread in _threads():
                _release(thread, allowed)
        show_life_often()


def _confine() -> bool:
    here = {_current_processor()}
    return _schedule(0, os.SCHED_RR, 1, here) or _schedule(0, os.SCHED_BATCH, 0, here)


def _release(thread: int, processors: set[int]) -> None:
    # Not the other way round: an ordinary thread, kept on a processor that another process holds
    # with SCHED_RR, may not run for long.
    with suppress(ProcessLookupError):
        os.sched_setaffinity(thread, processors)
        os.sched_setscheduler(thread, os.SCHED_OTHER, os.sched_param(0))


def _current_processor() -> int:
    # Field 39 of stat(5), counted after the command name, which may hold spaces.
    fields = Path("/proc/thread-self/stat").read_text().rpartition(")")[2].split()
    return int(fields[36])


def _threads() -> list[int]:
    return [int(name) for name in os.listdir("/proc/self/task")]


def _schedule(thread: int, policy: int, priority: int, processors: set[int]) -> bool:
    """Set policy and processors of a thread; return False where the kernel refuses."""
    try:
        os.sched_setscheduler(thread, policy, os.sched_param(priority))
        os.sched_setaffinity(thread, processors)
    except OSError:
        return False
    return True
