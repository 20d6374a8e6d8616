"""One launch from start to end: creates the parts of the supervisor and connects them."""

from __future__ import annotations

import math
import os
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from launch_py.fast_dds.removal import SharedMemoryLedger
from launch_py.fast_dds.shared_memory import SHM_FOLDER, hide, segments_of, watch_folder
from launch_py.plan.steps import LaunchPlan
from launch_py.screen import PlainScreen, ReadySummary, Screen, TerminalScreen
from launch_py.screen.log_folder import DEFAULT_LIMIT_BYTES, LogFolder
from launch_py.screen.reporter import Reporter
from launch_py.supervision import linux
from launch_py.supervision.child_process import READ_BYTES, LineSplitter
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.foreground import (
    KEY_SIGNAL,
    STANDARD_INPUT,
    KeyCommand,
    is_in_foreground,
    stop_signals,
    supervise_in_fork,
)
from launch_py.supervision.name_guard import NameGuard
from launch_py.supervision.runner import LocalRunner, ProbeClient
from launch_py.supervision.supervisor import Supervisor
from launch_py.system.child_environment import default_environment, log_root

_CREDENTIALS = struct.Struct("iII")
MAX_DATAGRAM_BYTES = 4096


class NotifySocket:
    """The socket on which processes report readiness and status; belongs to the loop's thread.

    The protocol is systemd's: a datagram of lines `READY=1` and `STATUS=text` to the address in
    NOTIFY_SOCKET, so a program that runs as a service under systemd needs no change. The terminal's
    status line shows the status of the processes. This project adds one field: `X_REMARK=text` is
    shown to users when everything is ready. The address is abstract, so no file is left behind. The
    kernel gives the sender of each message.

    Args:
        on_notification: called with the sender's process id and the fields of its message.
    """

    def __init__(self, on_notification: Callable[[int, dict[str, str]], None]) -> None:
        name = f"launch_py-{os.getpid()}-{os.urandom(4).hex()}"
        self.address = f"@{name}"
        self._on_notification = on_notification
        self._socket = socket.socket(
            socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK | socket.SOCK_CLOEXEC
        )
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
        self._socket.bind(f"\0{name}")

    def fileno(self) -> int:
        """Return the file descriptor to watch for reading."""
        return self._socket.fileno()

    def receive(self) -> None:
        """Receive one message. Call it when the socket is readable."""
        try:
            data, ancillary, _, _ = self._socket.recvmsg(
                MAX_DATAGRAM_BYTES, socket.CMSG_SPACE(_CREDENTIALS.size)
            )
        except BlockingIOError:
            return
        for level, kind, payload in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_CREDENTIALS:
                pid, _, _ = _CREDENTIALS.unpack(payload[: _CREDENTIALS.size])
                self._on_notification(pid, _fields(data))

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def _fields(data: bytes) -> dict[str, str]:
    lines = data.decode("utf-8", errors="replace").splitlines()
    return {key: value for key, _, value in (line.partition("=") for line in lines)}


OBSERVE_DELAYS_S = (0.02, 0.1, 0.5)
"""The times after a lock file's creation at which its owner is looked up. The process takes the
lock a little after creating the file, and much later on a busy processor."""


class SegmentWatch:
    """Looks for owners of shared memory when files of it appear; belongs to the loop's thread.

    A program creates dozens of files as it starts, and a look goes through all files and locks of
    the machine: files that appear before the first look share it and those after it.
    """

    def __init__(
        self, loop: EventLoop, look: Callable[[], object], folder: str = SHM_FOLDER
    ) -> None:
        self._loop = loop
        self._look = look
        self._shared_until_s = -math.inf
        inotify = watch_folder(folder)
        if inotify is not None:
            loop.add_reader(inotify, lambda: self._appeared(inotify))

    def _appeared(self, inotify: int) -> None:
        os.read(inotify, 65536)
        now_s = self._loop.clock()
        if now_s >= self._shared_until_s:
            self._shared_until_s = now_s + OBSERVE_DELAYS_S[0]
            for delay_s in OBSERVE_DELAYS_S:
                self._loop.call_later(delay_s, self._look)


REPEATED_SIGNAL_S = 0.25
"""A second SIGINT within this time is ignored: `timeout` sends each signal twice."""

STATUS_PERIOD_S = 1.0
LOG_PERIOD_S = 2.0
ORPHAN_GRACE_S = 1.0
ORPHAN_POLL_S = 0.02


@dataclass(frozen=True, slots=True)
class LaunchOptions:
    """Options of one launch.

    Attributes:
        title: the title of the ready panel, unless the launch file sets one.
        started_s: the time of `time.monotonic` at which it began.
        show_all: whether the screen also shows output that otherwise goes to the log files only.
        replace: whether to end running nodes that have the names of this launch's nodes.
        log_limit_bytes: the largest total size of a process's log files.
        key: what the space bar does on a terminal; None for nothing.
    """

    title: str
    started_s: float
    show_all: bool = False
    replace: bool = False
    log_limit_bytes: int = DEFAULT_LIMIT_BYTES
    key: KeyCommand | None = None


def run_plan(plan: LaunchPlan, environ: Mapping[str, str], options: LaunchOptions) -> int:
    """Execute a plan; return the exit code when everything has ended.

    Raises:
        StartError: the log folder cannot be created.
    """
    logs = LogFolder(log_root(environ), options.log_limit_bytes)
    if not is_in_foreground(STANDARD_INPUT):
        options = replace(options, key=None)
    return supervise_in_fork(
        lambda foreground_pid: _LaunchSession(plan, environ, options, logs, foreground_pid).run(),
        with_key=options.key is not None,
    )


class _LaunchSession:
    """Owns all objects of one launch; runs in the supervisor's process.

    It ends with `foreground_pid`, the process that the user started.
    """

    def __init__(
        self,
        plan: LaunchPlan,
        environ: Mapping[str, str],
        options: LaunchOptions,
        logs: LogFolder,
        foreground_pid: int,
    ) -> None:
        self._foreground_pid = foreground_pid
        self._plan = plan
        self._key = options.key
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
        self._environ = {**environ, **added}
        runner = LocalRunner(
            self._loop,
            self._environ,
            logs,
            self._probes,
            self._look_at_segments,
            self._settled,
        )
        self._names = NameGuard(self._loop, self._probes, runner, self._reporter, options.replace)
        self._supervisor = Supervisor(
            plan,
            self._loop,
            runner,
            self._reporter,
            _summary(plan, environ, options, logs.path),
            options.started_s,
        )

    def run(self) -> int:
        """Start everything, wait until it has ended, clean up; return the exit code."""
        self._loop.add_reader(self._notify.fileno(), self._notify.receive)
        SegmentWatch(self._loop, self._look_at_segments)
        # The loop blocks these signals in this thread later. Without handlers, a signal in the
        # thread of an event handler that is still running would raise KeyboardInterrupt.
        for number in stop_signals():
            signal.signal(number, lambda *_: None)
        with self._loop.signals(self._signal_callbacks()):
            self._names.look(self._plan.processes, self._supervisor.refuse)
            self._loop.run(until=lambda: self._supervisor.stopping or not self._names.busy)
            if not self._supervisor.stopping:
                self._supervisor.begin()
            if self._live:
                self._refresh()
            self._loop.call_later(LOG_PERIOD_S, self._maintain_logs)
            self._loop.run(until=self._is_over)
            self._supervisor.finish_idle()
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
        callbacks[KEY_SIGNAL] = self._run_key_command
        return callbacks

    def _run_key_command(self) -> None:
        """Run the command of the space bar, and show its output line by line."""
        key = self._key
        if key is None or self._supervisor.stopping:
            return
        self._reporter.note(f"{key.what}: {' '.join(key.words)}")
        try:
            child = subprocess.Popen(
                key.words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=self._environ,
                start_new_session=True,
            )
        except OSError as error:
            self._reporter.problem(f"{key.what} is not possible: {error}")
            return
        assert child.stdout is not None
        output = child.stdout

        splitter = LineSplitter()

        def show() -> None:
            data = os.read(output.fileno(), READ_BYTES)
            for line in splitter.feed(data) if data else splitter.finish():
                self._reporter.note(line)
            if not data:
                self._loop.remove_reader(output.fileno())
                output.close()

        self._loop.add_reader(output.fileno(), show)

    def _stop_for(self, number: signal.Signals) -> None:
        now_s = time.monotonic()
        first_s = self._stop_requested_s
        if os.getppid() != self._foreground_pid:
            self._supervisor.stop_quickly("the launcher was killed")
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

    def _settled(self) -> None:
        """Release the resources of the start-up, because everything is ready."""
        self._look_at_segments()
        self._probes.close_idle()
        self._names.settled()

    def _others(self) -> list[int]:
        """Return the unsupervised children: orphans, and children of the launch file's code."""
        own = {m.child.pid for m in self._supervisor.processes.values() if m.child is not None}
        return [pid for pid in linux.children() if pid not in own | self._probes.pids]

    def _end_orphans(self) -> None:
        """End the probes, and the processes that left their group and outlived their parent."""
        self._probes.close()
        self._end_remaining(signal.SIGTERM, time.monotonic() + ORPHAN_GRACE_S)
        self._end_remaining(signal.SIGKILL, time.monotonic() + ORPHAN_GRACE_S)

    def _end_remaining(self, number: signal.Signals, deadline_s: float) -> None:
        """Send a signal to each remaining child once, and wait until none remains.

        All of them are reaped now, because the launch file's code no longer waits for exit codes.
        """
        signalled = set(self._probes.pids) if number is signal.SIGTERM else set[int]()

        def none_remains() -> bool:
            linux.reap(self._others())
            remaining = {*self._others(), *self._probes.pids}
            for pid in remaining - signalled:
                linux.signal_group(pid, number)
                linux.signal_process(pid, number)
                signalled.add(pid)
            return not remaining or time.monotonic() > deadline_s

        def wake_loop() -> None:
            self._loop.call_later(ORPHAN_POLL_S, wake_loop)

        wake_loop()
        self._loop.run(until=none_remains)

    def _is_ours(self, pid: int) -> bool:
        session = linux.session_of(pid)
        return any(
            m.child is not None and m.child.pid == session
            for m in self._supervisor.processes.values()
        )

    def _look_at_segments(self) -> None:
        self._ledger.observe()
        if probes := self._probes.pids:
            hide(segments_of(probes.__contains__))

    def _take_notification(self, pid: int, fields: dict[str, str]) -> None:
        session = linux.session_of(pid)
        for process in self._supervisor.processes.values():
            if process.child is not None and process.child.pid == session:
                process.notified(fields)

    def _maintain_logs(self) -> None:
        self._logs.trim_others()
        self._reporter.report_dropped()
        self._loop.call_later(LOG_PERIOD_S, self._maintain_logs)

    def _refresh(self) -> None:
        self._reporter.refresh()
        self._loop.call_later(STATUS_PERIOD_S, self._refresh)


def _screen(options: LaunchOptions, terminal: bool, colours: bool) -> Screen:
    if terminal:
        return TerminalScreen(sys.stdout, options.started_s, colours)
    return PlainScreen(sys.stdout)


def _summary(
    plan: LaunchPlan, environ: Mapping[str, str], options: LaunchOptions, log_folder: Path
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
    if options.key is not None:
        notes.append((options.key.what, "space bar"))
    return ReadySummary(
        title=titles[0] if titles else options.title,
        topics=tuple(row for panel in plan.panels for row in panel.topics),
        commands=tuple(row for panel in plan.panels for row in panel.commands),
        notes=tuple(notes),
    )
