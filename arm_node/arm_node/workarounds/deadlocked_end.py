"""Ends a process whose nodes cannot be destroyed, because Fast DDS has deadlocked.

A thread that hears that another process's publisher is gone holds the mutex of discovery and waits
for the thread of timers, whose next announcement waits for that mutex. From then on nothing that
has a timer can be destroyed. Processes that stop together, as those of a launch, meet it: with
Fast DDS 3.2.3 in one of a few hundred stops on a busy machine; upstream issue 6502 is about the
same two threads. With 2.14.5 one of some 300 stops of a small node did not end, beside busy ones.

rclpy holds Python's lock while it destroys a publisher, so no thread of Python could end the
process: a timer of the C library does.
"""

import ctypes
import sys
from contextlib import suppress

from arm_node.workarounds.switch import is_on

PATIENCE_S = 5
"""How long nodes may take; a process of a launch is killed 10 s after its signal to stop."""
_CLOCK_MONOTONIC = 1
_SIGEV_THREAD = 2


class _SignalEvent(ctypes.Structure):
    """`struct sigevent`: a call of `function(value)` in a thread of its own."""

    _fields_ = (
        ("value", ctypes.c_void_p),
        ("signal", ctypes.c_int),
        ("notify", ctypes.c_int),
        ("function", ctypes.c_void_p),
        ("attributes", ctypes.c_void_p),
        ("_reserved", ctypes.c_byte * 32),
    )


class _TimerSpec(ctypes.Structure):
    """`struct itimerspec`: interval and first time, in s and ns."""

    _fields_ = tuple(
        (name, ctypes.c_long) for name in ("interval_s", "interval_ns", "first_s", "first_ns")
    )


class DestructionLimit:
    """Ends the process unless its nodes are destroyed in time. Main thread."""

    def __init__(self) -> None:
        """Do nothing yet."""
        self._timer: ctypes.c_void_p | None = None

    def start(self, exit_code: int) -> None:
        """Let the process end with this code after `PATIENCE_S`; a second call does nothing."""
        if self._timer is None and is_on("deadlocked_end"):
            for stream in filter(None, (sys.stdout, sys.stderr)):
                with suppress(OSError, ValueError):
                    stream.flush()
            self._timer = end_after(PATIENCE_S, exit_code)

    def cancel(self) -> None:
        """Let the process live."""
        if self._timer is not None:
            ctypes.CDLL(None).timer_delete(self._timer)
            self._timer = None


def end_after(delay_s: int, exit_code: int) -> ctypes.c_void_p | None:
    """Let the C library call `_exit` after a time, whatever holds Python's lock then.

    Returns:
        The C library's timer; None if it has none left.
    """
    libc = ctypes.CDLL(None)
    function = ctypes.cast(libc._exit, ctypes.c_void_p).value
    event = _SignalEvent(value=exit_code, notify=_SIGEV_THREAD, function=function)
    timer = ctypes.c_void_p()
    if libc.timer_create(_CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) != 0:
        return None
    libc.timer_settime(timer, 0, ctypes.byref(_TimerSpec(first_s=delay_s)), None)
    return timer
