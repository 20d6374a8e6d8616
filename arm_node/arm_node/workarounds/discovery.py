"""Creates a participant that waiting peers discover immediately.

A Fast DDS participant announces itself a moment before it starts to listen. A waiting peer answers
within 0.3 ms, and only once. If the answer arrives before the participant listens, it is lost, and
the two do not find each other until the next periodic announcement, up to 3 s later. This works
around Fast DDS 2.14 and 3.2; no upstream issue is known.
"""

import logging
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from operator import methodcaller
from pathlib import Path
from typing import Any, TypeVar

from arm_node.workarounds.ports import lost_ports, shorten_liveness_pause
from arm_node.workarounds.private_files import hide_shared_memory, made_private
from arm_node.workarounds.switch import is_on

ATTEMPTS = 5
"""How often the first node is made; beside a busy process one in ten attempts fails."""
NodeT = TypeVar("NodeT")


def first_node(
    make: Callable[[], NodeT], destroy: Callable[[Any], object] = methodcaller("destroy_node")
) -> NodeT:
    """Return the first node of this process, which others discover immediately and can reach.

    If the ports of all attempts are lost, the last node is returned, and a warning is logged.

    Args:
        make: makes the node under `prompt_discovery`; called again if its ports are lost.
        destroy: destroys it, so that its context has no node left.
    """
    attempts_left = ATTEMPTS
    while True:
        with prompt_discovery():
            node = make()
        attempts_left -= 1
        lost = lost_ports()
        if not (lost and attempts_left):
            break
        destroy(node)
    if lost:
        logging.getLogger("arm_node").warning(
            "this process hears nothing from others, because %s was removed while it was opened, "
            "%d times in a row; start it again",
            " and ".join(lost),
            ATTEMPTS,
        )
    return node


@contextmanager
def prompt_discovery() -> Iterator[None]:
    """Keep answers to the first announcement in the sockets until the participant listens.

    `first_node` creates the process's first node inside. Threads inherit their creator's
    scheduling, so Fast DDS's receiving threads start on this thread's processor and cannot preempt
    it. They read the sockets when this thread first waits, and by then the participant listens.
    SCHED_RR, if the process may use it, also keeps other processes off the processor; SCHED_BATCH
    needs no privilege. SCHED_FIFO would not work: one of Fast DDS's threads may wait for this one
    in a busy loop and would never yield the processor. Afterwards all threads are scheduled as
    before, and the process's liveness flag is refreshed often; see `ports`.

    Only this user can read what Fast DDS creates in shared memory; see `private_files`.
    """
    allowed = os.sched_getaffinity(0)
    ordinary = os.sched_getscheduler(0) == os.SCHED_OTHER
    confined = ordinary and is_on("discovery") and _confine()
    try:
        with made_private():
            yield
    finally:
        if confined:
            for thread in _threads():
                _release(thread, allowed)
        shorten_liveness_pause()
        hide_shared_memory()


def _confine() -> bool:
    here = {_current_processor()}
    return _schedule(0, os.SCHED_RR, 1, here) or _schedule(0, os.SCHED_BATCH, 0, here)


def _release(thread: int, processors: set[int]) -> None:
    # In this order: a thread of ordinary priority that is confined to a processor on which another
    # process uses SCHED_RR may not run for a long time.
    with suppress(ProcessLookupError):
        os.sched_setaffinity(thread, processors)
        os.sched_setscheduler(thread, os.SCHED_OTHER, os.sched_param(0))


def _current_processor() -> int:
    # Field 39 of stat(5), counted after the command name, which may contain spaces.
    fields = Path("/proc/thread-self/stat").read_text().rpartition(")")[2].split()
    return int(fields[36])


def _threads() -> list[int]:
    return [int(name) for name in os.listdir("/proc/self/task")]


def _schedule(thread: int, policy: int, priority: int, processors: set[int]) -> bool:
    """Set policy and processors of a thread; return whether the kernel allows it."""
    try:
        os.sched_setscheduler(thread, policy, os.sched_param(priority))
        os.sched_setaffinity(thread, processors)
    except OSError:
        return False
    return True
