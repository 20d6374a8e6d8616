"""One run of one process: start, output, signals and end, with its whole process group."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from launch_py.errors import StartError
from launch_py.plan.steps import StopDelays
from launch_py.supervision import linux
from launch_py.supervision.event_loop import EventLoop, Timer

MAX_LINE_BYTES = 65536
"""A longer line is cut: a process that never writes a newline must not fill the memory."""


class LineSplitter:
    """Collects bytes and returns complete lines as text."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> Iterator[str]:
        """Yield the lines that `data` completes."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            yield _text(line)
        while len(self._rest) > MAX_LINE_BYTES:
            line, self._rest = self._rest[:MAX_LINE_BYTES], self._rest[MAX_LINE_BYTES:]
            yield _text(line)

    def finish(self) -> Iterator[str]:
        """Yield what is left without a newline."""
        rest, self._rest = self._rest, b""
        if rest:
            yield _text(rest)


def _text(line: bytes) -> str:
    """Return a line as a terminal shows it: the part after its last carriage return."""
    return line.decode("utf-8", errors="replace").rstrip("\r").rpartition("\r")[2]


GROUP_GRACE_S = 1.0
"""How long the rest of a process group may take to end after SIGTERM, before SIGKILL."""

GROUP_POLL_S = 0.02
"""How often a group without its leader is checked: no signal reports its end."""

MAX_DRAIN_READS = 256
READ_BYTES = 65536


@dataclass(frozen=True, slots=True)
class ChildSpec:
    """The command line of a process, and where and how to run it."""

    command: Sequence[str]
    environment: Mapping[str, str]
    cwd: str | None
    emulate_tty: bool


class ChildProcess:
    """A started process in a session of its own; belongs to the loop's thread.

    It counts as ended when its leader has exited and its process group is empty. Processes that a
    crashed leader leaves in the group are stopped before `on_end` is called.

    Args:
        loop: the event loop.
        spec: what to start.
        on_line: called with the stream, "stdout" or "stderr", and each line.
        on_end: called once with the exit code; a signal counts as 128 + its number.
        before_kill: called before SIGKILL is sent, while the process can still be inspected.
    """

    def __init__(
        self,
        loop: EventLoop,
        spec: ChildSpec,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
        before_kill: Callable[[], None],
    ) -> None:
        self.spec = spec
        self.killed = False
        """Whether it had to be ended by SIGKILL."""
        self.ended = False
        self._loop = loop
        self._on_line = on_line
        self._on_end = on_end
        self._before_kill = before_kill
        self._streams: dict[int, tuple[str, LineSplitter]] = {}
        self._escalation: Timer | None = None
        self._exit_code: int | None = None
        self._process = self._start(spec)

    @property
    def pid(self) -> int:
        """The process id, which is also its session id and group id."""
        return self._process.pid

    def stop(self, delays: StopDelays) -> None:
        """Send SIGINT to the process, then SIGTERM and SIGKILL to its group, until it ends.

        Only the leader gets SIGINT, because it knows how to end its children. Processes that it
        leaves behind get SIGTERM.
        """
        if self._exit_code is None:
            linux.signal_process(self.pid, signal.SIGINT)
            # A stopped process handles SIGINT only after SIGCONT.
            linux.signal_process(self.pid, signal.SIGCONT)
        self._escalate(delays.sigterm_timeout_s, lambda: self._terminate(delays))

    def signal(self, number: int) -> None:
        """Send it a signal; its children get none."""
        linux.signal_process(self.pid, number)

    def kill(self) -> None:
        """Send SIGKILL to the group now."""
        if self.ended:
            return
        self._before_kill()
        if self._exit_code is None:
            self.killed = True
        else:
            # A remaining process may be a zombie that its parent never reaps: do not wait for it.
            self._escalate(GROUP_GRACE_S, self._end)
        self._signal(signal.SIGKILL)

    def reap(self) -> None:
        """Check whether the leader has ended. Call it after SIGCHLD."""
        if self._exit_code is not None or self.ended:
            return
        code = self._process.poll()
        if code is not None:
            self._exit_code = code if code >= 0 else 128 - code
            self._finish_group()

    def _start(self, spec: ChildSpec) -> subprocess.Popen[bytes]:
        if spec.emulate_tty:
            streams = [("stdout", *os.openpty())]
        else:
            streams = [("stdout", *os.pipe()), ("stderr", *os.pipe())]
        try:
            process = subprocess.Popen(
                spec.command,
                stdin=subprocess.DEVNULL,
                stdout=streams[0][2],
                stderr=streams[-1][2],
                env=spec.environment,
                cwd=spec.cwd,
                start_new_session=True,
                preexec_fn=linux.kill_with_parent(),
            )
        except (OSError, ValueError, subprocess.SubprocessError) as error:
            for _, readable, _ in streams:
                os.close(readable)
            raise StartError(f"cannot run {spec.command[0]}: {_reason(error, spec)}") from error
        finally:
            for _, _, writable in streams:
                os.close(writable)
        for name, readable, _ in streams:
            self._read_from(readable, name)
        return process

    def _read_from(self, fd: int, stream: str) -> None:
        os.set_blocking(fd, False)
        self._streams[fd] = (stream, LineSplitter())
        self._loop.add_reader(fd, lambda: self._read(fd))

    def _read(self, fd: int) -> bool:
        """Read once; return whether there may be more."""
        stream, splitter = self._streams[fd]
        try:
            data = os.read(fd, READ_BYTES)
        except BlockingIOError:
            return False
        except OSError:
            data = b""  # The other end of a pseudo terminal is closed.
        lines = splitter.feed(data) if data else splitter.finish()
        for line in lines:
            self._on_line(stream, line)
        if not data:
            self._close(fd)
        return bool(data)

    def _close(self, fd: int) -> None:
        self._loop.remove_reader(fd)
        del self._streams[fd]
        os.close(fd)

    def _signal(self, number: signal.Signals) -> None:
        if not self.ended:
            linux.signal_group(self.pid, number)

    def _escalate(self, delay_s: float, action: Callable[[], None]) -> None:
        if self._escalation is not None:
            self._escalation.cancel()
        self._escalation = self._loop.call_later(delay_s, action)

    def _terminate(self, delays: StopDelays) -> None:
        self._signal(signal.SIGTERM)
        self._escalate(delays.sigkill_timeout_s, self.kill)

    def _finish_group(self) -> None:
        if linux.signal_group(self.pid, signal.SIGTERM):
            self._escalate(GROUP_GRACE_S, self.kill)
            self._await_group()
        else:
            self._end()

    def _await_group(self) -> None:
        if not self.ended and linux.group_exists(self.pid):
            self._loop.call_later(GROUP_POLL_S, self._await_group)
        else:
            self._end()

    def _end(self) -> None:
        if self.ended:
            return
        if self._escalation is not None:
            self._escalation.cancel()
        self.ended = True
        for fd in list(self._streams):
            reads = 0
            while fd in self._streams and reads < MAX_DRAIN_READS and self._read(fd):
                reads += 1
            if fd in self._streams:  # A descendant in a session of its own holds it open.
                stream, splitter = self._streams[fd]
                for line in splitter.finish():
                    self._on_line(stream, line)
                self._close(fd)
        self._on_end(self._exit_code or 0)


def _reason(error: Exception, spec: ChildSpec) -> str:
    if isinstance(error, OSError):
        missing = spec.cwd is not None and not os.path.isdir(spec.cwd)
        return f"there is no folder {spec.cwd}" if missing else str(error.strerror).lower()
    return (_invalid_text(spec) if isinstance(error, ValueError) else None) or str(error)


def _invalid_text(spec: ChildSpec) -> str | None:
    """Return why a word or a variable cannot be passed to a process, None if all can."""
    for name, value in spec.environment.items():
        if "=" in name:
            return f"no environment variable can be named {name!r}"
        if "\0" in name + value:
            return f"environment variable {name!r} holds a null character"
    for word in spec.command:
        if "\0" in word:
            return f"argument {word!r} holds a null character"
    return None
