"""Fakes for tests of launch files and of what is built on the supervisor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Unpack

from launch_py.actions.execute_process import ExecuteProcess, ProcessOptions
from launch_py.errors import StartError
from launch_py.plan import ProcessStep, StopDelays
from launch_py.readiness import Probe
from launch_py.screen.screen import ReadySummary
from launch_py.supervision.child_process import ChildSpec


class ManualClock:
    """A clock that stands still until it is told to advance; call it for the time in seconds."""

    def __init__(self, now_s: float = 0.0) -> None:
        self.now_s = now_s

    def __call__(self) -> float:
        """Return the time."""
        return self.now_s

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        self.now_s += seconds


def fake_process(name: str, **options: Unpack[ProcessOptions]) -> ExecuteProcess:
    """Return a process for a `FakeRunner`: its command does not matter."""
    return ExecuteProcess(cmd=["true"], name=name, **options)


class FakeChild:
    """A process that only exists in a test: it writes and ends when the test says so."""

    def __init__(
        self,
        pid: int,
        spec: ChildSpec,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
    ) -> None:
        self.pid = pid
        self.spec = spec
        self.killed = False
        self.stop_delays: StopDelays | None = None
        """What it was asked to stop with, None while it was not."""
        self._on_line = on_line
        self._on_end = on_end

    def write(self, text: str, stream: str = "stdout") -> None:
        """Let it write a line."""
        self._on_line(stream, text)

    def end(self, exit_code: int = 0) -> None:
        """Let it end."""
        self._on_end(exit_code)

    def stop(self, delays: StopDelays) -> None:
        """Note that it is asked to end."""
        self.stop_delays = delays

    def kill(self) -> None:
        """End as by SIGKILL."""
        self.killed = True
        self._on_end(137)

    def reap(self) -> None:
        """Do nothing: it ends when the test says so."""


class FakeRunner:
    """Starts fake processes and remembers them by name, the newest run of each."""

    def __init__(self, cannot_start: Sequence[str] = ()) -> None:
        self.children: dict[str, FakeChild] = {}
        self.started: list[str] = []
        """The names in the order of their starts, restarts included."""
        self.watched: dict[Probe, Callable[[], None]] = {}
        self.doomed: dict[Probe, Callable[[str], None]] = {}
        self.is_settled = False
        self._cannot_start = cannot_start

    def start(
        self,
        step: ProcessStep,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
    ) -> FakeChild:
        """Start a fake process; raises StartError for a name that cannot start."""
        if step.name in self._cannot_start:
            raise StartError(f"no such program {step.command[0]}")
        self.started.append(step.name)
        command = [str(word) for word in step.command]
        spec = ChildSpec(command, {"FAKE": "1"}, step.cwd, step.emulate_tty)
        child = FakeChild(1000 + len(self.started), spec, on_line, on_end)
        self.children[step.name] = child
        return child

    def watch(
        self,
        step: ProcessStep,
        condition: Probe,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Remember the condition.

        A test meets it by calling `watched[condition]`, and says why it can never be met by
        calling `doomed[condition]`.
        """
        self.watched[condition] = on_met
        self.doomed[condition] = on_failed
        return lambda: None

    def settled(self) -> None:
        """Remember that the start-up is over."""
        self.is_settled = True


class RecordingScreen:
    """A screen that keeps what it is shown, one text each, for tests."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.problems: list[str] = []
        self.ready_after_s: float | None = None
        self.last_line: str | None = None

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Do nothing."""

    def line(self, name: str, text: str) -> None:
        """Keep a line of a process as `[name] text`."""
        self.lines.append(f"[{name}] {text}")

    def note(self, text: str) -> None:
        """Keep what the supervisor says."""
        self.lines.append(text)

    def problem(self, text: str) -> None:
        """Keep what went wrong."""
        self.lines.append(text)
        self.problems.append(text)

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Keep the time."""
        self.ready_after_s = elapsed_s

    def refresh(self) -> None:
        """Do nothing."""

    def end(self, text: str, failed: bool) -> None:
        """Keep the last line."""
        self.last_line = text
