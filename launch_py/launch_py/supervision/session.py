"""One launch from its first process to its last line: puts the parts together."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from launch_py.child_environment import default_environment
from launch_py.plan import Plan
from launch_py.screen import PlainScreen, ReadySummary, Screen, TerminalScreen
from launch_py.supervision import linux
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.front import stop_signals, supervise_in_fork
from launch_py.supervision.log_folder import LogFolder, log_root
from launch_py.supervision.notify_socket import NotifySocket
from launch_py.supervision.probe_client import ProbeClient
from launch_py.supervision.reporter import Reporter
from launch_py.supervision.runner import LocalRunner
from launch_py.supervision.shared_memory import SharedMemoryLedger, watch_folder
from launch_py.supervision.supervisor import Supervisor

OBSERVE_DELAYS_S = (0.02, 0.1, 0.5)
"""From the creation of a lock file to the looks at who holds it: the lock is taken next, which may
take a while where the processor is busy."""

REPEATED_SIGNAL_S = 0.25
"""A second SIGINT within this time is the first one again: `timeout` sends each signal twice."""

STATUS_PERIOD_S = 1.0
ORPHAN_GRACE_S = 1.0
ORPHAN_POLL_S = 0.02


@dataclass(frozen=True, slots=True)
class SessionOptions:
    """How one launch is shown; `started_s` is the time of `time.monotonic` at which it began."""

    title: str
    started_s: float
    show_all: bool = False


def run_plan(plan: Plan, environ: Mapping[str, str], options: SessionOptions) -> int:
    """Carry out a plan; return the exit code when everything has ended.

    Raises:
        StartError: the log folder cannot be made.
    """
    logs = LogFolder(log_root(environ))
    return supervise_in_fork(
        lambda front_pid: Session(plan, environ, options, logs, front_pid).run()
    )


class Session:
    """Everything that lives as long as one launch; runs in the supervisor's process.

    Args:
        plan: what to do.
        environ: the environment of the supervisor.
        options: how it is shown.
        logs: the log folder.
        front_pid: the process that the user started; its end is the end of everything.
    """

    def __init__(
        self,
        plan: Plan,
        environ: Mapping[str, str],
        options: SessionOptions,
        logs: LogFolder,
        front_pid: int,
    ) -> None:
        self._front_pid = front_pid
        self._logs = logs
        self._stop_requested_s: float | None = None
        self._loop = EventLoop()
        terminal = sys.stdout.isatty() and environ.get("TERM") != "dumb"
        colours = terminal and not environ.get("NO_COLOR")
        self._live = terminal
        self._reporter = Reporter(_screen(options, terminal, colours), logs, options.show_all)
        self._notify = NotifySocket(self._take_notification)
        self._ledger = SharedMemoryLedger(self._is_ours)
        self._probes = ProbeClient(self._loop, logs.path / "probe.log")
        added = default_environment(environ, logs.path, self._notify.address, colours)
        runner = LocalRunner(
            self._loop, {**environ, **added}, logs, self._probes, self._ledger.observe
        )
        self._supervisor = Supervisor(
            plan,
            self._loop,
            runner,
            self._reporter,
            _summary(plan, environ, options, logs.path),
            options.started_s,
        )

    def run(self) -> int:
        """Start everything, wait for its end, clean up; return the exit code."""
        self._loop.add_reader(self._notify.fileno(), self._notify.receive)
        inotify = watch_folder()
        if inotify is not None:
            self._loop.add_reader(inotify, lambda: self._segments_appeared(inotify))
        # Afterwards they are blocked here, but not in the thread of a function that is not waited
        # for: there one would raise KeyboardInterrupt in the last lines.
        for number in stop_signals():
            signal.signal(number, lambda *_: None)
        with self._loop.signals(self._signal_callbacks()):
            self._supervisor.begin()
            if self._live:
                self._refresh()
            self._loop.run(until=self._is_over)
            self._supervisor.rest()
            self._loop.run(until=self._is_over)
            self._end_orphans()
        self._ledger.sweep()
        code = self._supervisor.finish()
        self._notify.close()
        self._logs.close()
        self._loop.close()
        return code

    def _signal_callbacks(self) -> dict[signal.Signals, Callable[[], None]]:
        callbacks: dict[signal.Signals, Callable[[], None]] = {
            number: lambda n=number: self._stop_for(n) for number in stop_signals()
        }
        callbacks[signal.SIGCHLD] = self._reap
        return callbacks

    def _stop_for(self, number: signal.Signals) -> None:
        now_s = time.monotonic()
        first_s = self._stop_requested_s
        if os.getppid() != self._front_pid:
            self._supervisor.stop_hastily("the launcher was killed")
        elif number is signal.SIGQUIT:
            self._supervisor.kill("stopped now by SIGQUIT")
        elif first_s is None:
            self._stop_requested_s = now_s
            hint = "; Ctrl-C again stops now" if number is signal.SIGINT else ""
            self._supervisor.stop(f"{number.name} received{hint}")
        elif number is signal.SIGINT and now_s - first_s > REPEATED_SIGNAL_S:
            self._supervisor.kill("stopped now by a second Ctrl-C")

    def _is_over(self) -> bool:
        if self._reporter.screen_is_gone and not self._supervisor.stopping:
            self._supervisor.stop("nobody reads the output any more")
        return self._supervisor.done

    def _reap(self) -> None:
        if not linux.child_has_ended():
            return
        self._supervisor.reap()
        self._probes.reap()
        linux.reap(linux.adopted_children())
        self._ledger.sweep()

    def _others(self) -> list[int]:
        """Return the children that nobody supervises: orphans, and what functions have started."""
        own = {m.child.pid for m in self._supervisor.members.values() if m.child is not None}
        return [pid for pid in linux.children() if pid not in own | self._probes.pids]

    def _end_orphans(self) -> None:
        """End what left its process group and so outlived its parent, and the probes."""
        self._probes.close()
        self._end_remaining(signal.SIGTERM, time.monotonic() + ORPHAN_GRACE_S)
        self._end_remaining(signal.SIGKILL, time.monotonic() + ORPHAN_GRACE_S)

    def _end_remaining(self, number: signal.Signals, deadline_s: float) -> None:
        """Send a signal to each remaining child once, and wait until none is left.

        All are reaped now: no function is waited for any more that would want an exit code.
        """
        signalled = set(self._probes.pids) if number is signal.SIGTERM else set[int]()

        def none_is_left() -> bool:
            linux.reap(self._others())
            remaining = {*self._others(), *self._probes.pids}
            for pid in remaining - signalled:
                linux.signal_group(pid, number)
                linux.signal_process(pid, number)
                signalled.add(pid)
            return not remaining or time.monotonic() > deadline_s

        def look_again() -> None:
            self._loop.call_later(ORPHAN_POLL_S, look_again)

        look_again()
        self._loop.run(until=none_is_left)

    def _is_ours(self, pid: int) -> bool:
        session = linux.session_of(pid)
        return any(
            m.child is not None and m.child.pid == session
            for m in self._supervisor.members.values()
        )

    def _segments_appeared(self, inotify: int) -> None:
        os.read(inotify, 65536)
        for delay_s in OBSERVE_DELAYS_S:
            self._loop.call_later(delay_s, self._ledger.observe)

    def _take_notification(self, pid: int, fields: dict[str, str]) -> None:
        session = linux.session_of(pid)
        for member in self._supervisor.members.values():
            if member.child is not None and member.child.pid == session:
                member.notified(fields)

    def _refresh(self) -> None:
        self._reporter.refresh()
        self._loop.call_later(STATUS_PERIOD_S, self._refresh)


def _screen(options: SessionOptions, terminal: bool, colours: bool) -> Screen:
    if terminal:
        return TerminalScreen(sys.stdout, options.started_s, colours)
    return PlainScreen(sys.stdout)


def _summary(
    plan: Plan, environ: Mapping[str, str], options: SessionOptions, log_folder: Path
) -> ReadySummary:
    titles = [panel.title for panel in plan.panels if panel.title]
    discovery = environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    domain = environ.get("ROS_DOMAIN_ID", "0")
    notes = [note for panel in plan.panels for note in panel.notes]
    notes += [
        ("logs", str(log_folder)),
        ("ROS_DOMAIN_ID", f"{domain}, discovery {discovery}"),
        ("stop", "Ctrl-C; twice: now"),
    ]
    return ReadySummary(
        title=titles[0] if titles else options.title,
        topics=tuple(row for panel in plan.panels for row in panel.topics),
        commands=tuple(row for panel in plan.panels for row in panel.commands),
        notes=tuple(notes),
    )
