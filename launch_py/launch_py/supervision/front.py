"""The process that the user started: it holds the terminal and outlives a dead supervisor.

The supervisor runs in a fork of it, in a session of its own. Each watches over the other:

* The front passes signals on and ends with the supervisor's exit code.
* If the front is killed (SIGKILL, too), the supervisor gets SIGTERM and ends everything in order,
  so even then no process, grandchild or shared-memory file stays behind.
* If the supervisor is killed, its children die with it (parent-death signal) and the front, to
  which all orphans fall, ends what is left.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import suppress

from launch_py.supervision import linux

PASSED_ON = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
EXIT_CRASHED = 70
ORPHAN_POLL_S = 0.01
ORPHAN_TIMEOUT_S = 2.0


def supervise_in_fork(supervise: Callable[[int], int]) -> int:
    """Run `supervise` in a fork of this process and return its exit code.

    Args:
        supervise: gets the process id of the front; must unblock and handle `stop_signals`.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    linux.become_subreaper()
    front_pid = os.getpid()
    # Blocked for good: the front takes them one by one with sigwait. A handler would run inside
    # itself under a flood of signals, and they must not kill on the way in or out either.
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # Ignored, no child could be waited for.
    awaited = {*stop_signals(), signal.SIGCHLD}
    signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    supervisor_pid = os.fork()
    if supervisor_pid == 0:
        _run_supervisor(supervise, front_pid)
    while True:
        number = signal.sigwait(awaited)
        if number != signal.SIGCHLD:
            linux.signal_process(supervisor_pid, signal.Signals(number))
            continue
        status = _reap(supervisor_pid)
        if status is not None:
            _kill_orphans()
            code = os.waitstatus_to_exitcode(status)
            return code if code >= 0 else 128 - code


def stop_signals() -> list[signal.Signals]:
    """Return the signals that stop everything: not SIGHUP under nohup, which ignores it.

    SIGINT counts even where it is ignored, as in what a shell script starts with `&`: whoever
    sends it to this process by `kill` means it.
    """
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return [n for n in PASSED_ON if not (ignored and n is signal.SIGHUP)]


def _run_supervisor(supervise: Callable[[int], int], front_pid: int) -> None:
    code = EXIT_CRASHED
    try:
        linux.die_with_parent(front_pid, signal.SIGTERM)
        os.setsid()
        linux.become_subreaper()
        code = supervise(front_pid)
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        pass  # Nobody reads the output any more; everything has ended in order.
    except BaseException:
        traceback.print_exc()
    finally:
        # Not sys.exit: this is a fork, what the front registered for its exit is not for us.
        os._exit(code)


def _reap(supervisor_pid: int) -> int | None:
    """Take the status of all ended children; return the supervisor's, if it is among them."""
    found = None
    with suppress(ChildProcessError):
        while (ended := os.waitpid(-1, os.WNOHANG))[0]:
            if ended[0] == supervisor_pid:
                found = ended[1]
    return found


def _kill_orphans() -> None:
    """Kill this process's children until none is left: each may leave children of its own."""
    deadline_s = time.monotonic() + ORPHAN_TIMEOUT_S
    while (pids := linux.children()) and time.monotonic() < deadline_s:
        for pid in pids:
            linux.signal_group(pid, signal.SIGKILL)
            linux.signal_process(pid, signal.SIGKILL)
        linux.reap(pids)
        time.sleep(ORPHAN_POLL_S)
