"""Linux system calls for supervising processes that Python does not wrap."""

from __future__ import annotations

import ctypes
import os
import signal
import time
from collections.abc import Callable
from contextlib import suppress

_PR_SET_PDEATHSIG = 1
_PR_SET_CHILD_SUBREAPER = 36
LONGEST_INTERPRETER_START_S = 3.0


def _prctl(option: int, value: int) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(option, ctypes.c_ulong(value), 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), f"prctl({option}) failed")


def become_subreaper() -> None:
    """Make this process, not init, the new parent of orphans among its descendants."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def end_with_parent(parent_pid: int, number: signal.Signals) -> None:
    """Ask the kernel for a signal when the parent ends; exit at once if it has ended already.

    To the kernel the parent is the thread that forked this process, so only a main thread should
    fork.
    """
    _prctl(_PR_SET_PDEATHSIG, number)
    if os.getppid() != parent_pid:
        os._exit(1)


def kill_with_parent() -> Callable[[], None]:
    """Return a function for a child to call before exec, so that it dies with this process.

    Everything is prepared here, so the child only makes two system calls. The launcher forks from
    its only thread, so no other thread can hold a lock.
    """
    libc = ctypes.CDLL(None, use_errno=True)
    parent_pid = os.getpid()
    value = ctypes.c_ulong(signal.SIGKILL)

    def in_child() -> None:
        libc.prctl(_PR_SET_PDEATHSIG, value, 0, 0, 0)
        if os.getppid() != parent_pid:
            os._exit(1)

    return in_child


def children() -> list[int]:
    """Return the process ids of this process's children, adopted orphans included."""
    pids: list[int] = []
    for thread in os.listdir("/proc/self/task"):
        try:
            with open(f"/proc/self/task/{thread}/children", encoding="ascii") as file:
                pids.extend(int(word) for word in file.read().split())
        except OSError:
            continue  # The thread has ended, or the kernel lacks this file.
    return pids


def adopted_children() -> list[int]:
    """Return the children that are certainly orphans, started by other processes.

    Call it in a session leader whose supervised children lead sessions of their own. A child that
    this process has started itself, as a function of the launch file does with subprocess, is in
    its session or leads one. It is not returned: reaping it here would lose its exit code. An
    orphan that leads a session looks like such a child and is not returned either.
    """
    own = os.getsid(0)
    return [pid for pid in children() if session_of(pid) not in (own, pid, None)]


def child_has_ended() -> bool:
    """Return whether a child waits to be reaped. SIGCHLD also comes when one stops or continues."""
    try:
        return os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
    except ChildProcessError:
        return False


def reap(pids: list[int]) -> None:
    """Reap the listed children that have ended."""
    for pid in pids:
        with suppress(ChildProcessError):
            os.waitpid(pid, os.WNOHANG)


def group_exists(group: int) -> bool:
    """Return whether a process group has members."""
    return signal_group(group, None)


def signal_group(group: int, number: signal.Signals | None) -> bool:
    """Send a signal to a process group; return whether it has members."""
    try:
        os.killpg(group, number or 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True  # Some member runs as another user.
    return True


def signal_process(pid: int, number: int) -> None:
    """Send a signal to a process that may be gone already."""
    with suppress(ProcessLookupError, PermissionError):
        os.kill(pid, number)


def session_of(pid: int) -> int | None:
    """Return the session of a process, None if it is gone."""
    try:
        return os.getsid(pid)
    except OSError:
        return None


def start_ticks(pid: int) -> int | None:
    """Return when a process started, in clock ticks after boot; None if it has ended.

    See proc_pid_stat(5): field 22, of which the second one is in parentheses.
    """
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            return int(file.read().rpartition(b")")[2].split()[19])
    except (OSError, IndexError, ValueError):
        return None


def start_of_program(entered_s: float) -> float:
    """Return when this program was started, on `time.monotonic`, before its interpreter started.

    A shell may have exec'd this program, as in `bash -c "pip install . && arm launch"`. The age of
    the process is then ignored. `entered_s` is when its first line ran, on the same clock.
    """
    forked_s = _forked_s()
    return forked_s if 0.0 <= entered_s - forked_s <= LONGEST_INTERPRETER_START_S else entered_s


def _forked_s() -> float:
    """Return when this process was forked, on `time.monotonic`."""
    forked_ticks = start_ticks(os.getpid()) or 0
    age_s = time.clock_gettime(time.CLOCK_BOOTTIME) - forked_ticks / os.sysconf("SC_CLK_TCK")
    return time.monotonic() - max(0.0, age_s)
