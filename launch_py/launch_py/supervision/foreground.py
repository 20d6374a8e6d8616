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
import select
import signal
import sys
import termios
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass

from launch_py.fast_dds.removal import remove_abandoned
from launch_py.supervision import linux

KEY = b" "
LOCAL_MODES = 3
"""Index of the local modes in what `termios.tcgetattr` returns."""
BACKGROUND_POLL_S = 0.5
"""How often a launch in the background checks whether it is in the foreground again."""


@dataclass(frozen=True, slots=True)
class KeyCommand:
    """A command for the space bar.

    Attributes:
        what: its name on the screen, such as "emergency stop".
        words: the command and its arguments.
    """

    what: str
    words: tuple[str, ...]


def is_in_foreground(fd: int) -> bool:
    """Return whether keys typed on this terminal are meant for this process."""
    try:
        return os.isatty(fd) and os.tcgetpgrp(fd) == os.getpgrp()
    except OSError:  # It is not a terminal, or not the one of this process.
        return False


@contextmanager
def space_bar_watched(fd: int, press: Callable[[], None]) -> Iterator[None]:
    """Call back for each press of the space bar, on a thread of its own; Ctrl-C works as before.

    In the background nothing is read, because the keys belong to the shell. Without a terminal
    nothing happens.
    """
    if not is_in_foreground(fd):
        yield
        return
    before = termios.tcgetattr(fd)
    _take_single_keys(fd)
    ending = threading.Event()
    # A daemon thread, because it may still wait for a key when the process ends.
    threading.Thread(target=_listen, args=(fd, press, ending), daemon=True).start()
    try:
        yield
    finally:
        ending.set()
        if is_in_foreground(fd):
            with suppress(termios.error):
                termios.tcsetattr(fd, termios.TCSANOW, before)


def _take_single_keys(fd: int) -> None:
    """Deliver each key at once and do not show it."""
    modes = termios.tcgetattr(fd)
    modes[LOCAL_MODES] &= ~(termios.ICANON | termios.ECHO)
    termios.tcsetattr(fd, termios.TCSANOW, modes)


def _listen(fd: int, press: Callable[[], None], ending: threading.Event) -> None:
    was_away = False
    while not ending.is_set():
        if not is_in_foreground(fd):
            was_away = True
            time.sleep(BACKGROUND_POLL_S)
            continue
        if was_away:
            # The shell has changed the terminal's modes in the meantime.
            was_away = False
            _take_single_keys(fd)
        if not select.select([fd], [], [], BACKGROUND_POLL_S)[0] or not is_in_foreground(fd):
            continue
        try:
            typed = os.read(fd, 1024)
        except OSError:  # The terminal has gone.
            return
        if not typed:
            return
        if KEY in typed:
            press()


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

    def pass_key_on() -> None:
        linux.signal_process(supervisor_pid, KEY_SIGNAL)

    with space_bar_watched(STANDARD_INPUT, pass_key_on) if with_key else nullcontext():
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
