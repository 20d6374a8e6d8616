"""The foreground process, which the user started. It survives if the supervisor is killed.

The supervisor runs in a fork of it, in a session of its own. Each reacts when the other ends:

* The foreground process passes signals on and ends with the supervisor's exit code.
* If the foreground process is killed (even by SIGKILL), the supervisor gets SIGTERM and stops
  everything in order, so no process, grandchild or shared-memory file stays behind.
* If the supervisor is killed, its children die with it (parent-death signal). The foreground
  process adopts all orphans, ends them and removes what they left in shared memory.

While the supervisor starts, the foreground process also removes what earlier launches left there.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext, suppress

from launch_py.fast_dds.abandoned_memory import remove_abandoned
from launch_py.supervision import linux

PASSED_ON = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
KEY_SIGNAL = signal.SIGUSR1
"""Tells the supervisor that the space bar was pressed."""
STANDARD_INPUT = 0
EXIT_CRASHED = 70
ORPHAN_POLL_S = 0.01
ORPHAN_TIMEOUT_S = 2.0


def supervise_in_fork(supervise: Callable[[int], int], *, with_key: bool = False) -> int:
    """Run `supervise` in a fork of this process and return its exit code.

    Args:
        supervise: gets the process id of the foreground process. It must unblock and handle
            `stop_signals`, and `KEY_SIGNAL` with the key.
        with_key: whether the space bar on this process's terminal sends `KEY_SIGNAL` to the
            supervisor.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    linux.become_subreaper()
    foreground_pid = os.getpid()
    # Blocked permanently: sigwait takes them one by one. With many signals a handler would run
    # inside itself, and a signal before or after the loop must not kill this process.
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # If it were ignored, waitpid would fail.
    awaited = {*stop_signals(), signal.SIGCHLD}
    signal.pthread_sigmask(signal.SIG_BLOCK, {*awaited, KEY_SIGNAL})
    supervisor_pid = os.fork()
    if supervisor_pid == 0:
        _run_supervisor(supervise, foreground_pid)
    remove_abandoned()
    keys = _key_passed_on(supervisor_pid) if with_key else nullcontext()
    with keys:
        return _pass_signals_on(supervisor_pid, awaited)


def _pass_signals_on(supervisor_pid: int, awaited: set[signal.Signals]) -> int:
    """Serve the supervisor until it ends; return its exit code."""
    while True:
        number = signal.sigwait(awaited)
        if number != signal.SIGCHLD:
            linux.signal_process(supervisor_pid, signal.Signals(number))
            continue
        status = _reap(supervisor_pid)
        if status is not None:
            _kill_orphans()
            code = os.waitstatus_to_exitcode(status)
            if code < 0 or code == EXIT_CRASHED:
                remove_abandoned()
            return code if code >= 0 else 128 - code


def _key_passed_on(supervisor_pid: int) -> AbstractContextManager[None]:
    # Imported only here, because most launches have no terminal.
    from launch_py.supervision.terminal_key import space_bar_watched

    return space_bar_watched(
        STANDARD_INPUT, lambda: linux.signal_process(supervisor_pid, KEY_SIGNAL)
    )


def stop_signals() -> list[signal.Signals]:
    """Return the signals that stop the launch. SIGHUP is not one under nohup, which ignores it.

    SIGINT counts even where it is ignored, as in a process that a shell script starts with `&`. It
    then comes from a `kill` that names this process.
    """
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return [n for n in PASSED_ON if not (ignored and n is signal.SIGHUP)]


def _run_supervisor(supervise: Callable[[int], int], foreground_pid: int) -> None:
    code = EXIT_CRASHED
    try:
        linux.end_with_parent(foreground_pid, signal.SIGTERM)
        os.setsid()
        linux.become_subreaper()
        code = supervise(foreground_pid)
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        pass  # The output's reader has gone. Everything has been stopped in order.
    except BaseException:
        # This is the last frame of the fork: an exception that left it would run the foreground
        # process's code a second time.
        traceback.print_exc()
    finally:
        # Not sys.exit: this is a fork and must not run the exit handlers of the foreground process.
        os._exit(code)


def _reap(supervisor_pid: int) -> int | None:
    """Reap all children that have ended; return the supervisor's status if it is among them."""
    found = None
    with suppress(ChildProcessError):
        while (ended := os.waitpid(-1, os.WNOHANG))[0]:
            if ended[0] == supervisor_pid:
                found = ended[1]
    return found


def _kill_orphans() -> None:
    """Kill this process's children until none remains; each may leave children of its own."""
    deadline_s = time.monotonic() + ORPHAN_TIMEOUT_S
    while (pids := linux.children()) and time.monotonic() < deadline_s:
        for pid in pids:
            linux.signal_group(pid, signal.SIGKILL)
            linux.signal_process(pid, signal.SIGKILL)
        linux.reap(pids)
        time.sleep(ORPHAN_POLL_S)
