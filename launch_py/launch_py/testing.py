"""Fakes for tests of launch files and of code that uses the supervisor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Unpack

from launch_py.actions.execute_process import ExecuteProcess, ProcessOptions
from launch_py.errors import StartError
from launch_py.plan.readiness import ProbedCondition
from launch_py.plan.steps import ProcessStep, StopDelays
from launch_py.screen.screen import ReadySummary
from launch_py.supervision.child_process import ChildSpec


class FakeClock:
    """A clock that only a test advances; call it for the time in seconds."""

    def __init__(self, now_s: float = 0.0) -> None:
        self.now_s = now_s

    def __call__(self) -> float:
        """Return the time."""
        return self.now_s

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        self.now_s += seconds


def fake_process(name: str, **options: Unpack[ProcessOptions]) -> ExecuteProcess:
    """Return a process for a `FakeRunner`, which ignores its command."""
    return ExecuteProcess(cmd=["true"], name=name, **options)


class FakeChild:
    """A fake process: it writes lines and exits when the test says so."""

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
        """The delays that `stop` was called with, None before that."""
        self.signals: list[int] = []
        """The signals that `signal` has sent."""
        self._on_line = on_line
        self._on_end = on_end

    def write(self, text: str, stream: str = "stdout") -> None:
        """Make the process write a line."""
        self._on_line(stream, text)

    def end(self, exit_code: int = 0) -> None:
        """Make the process exit."""
        self._on_end(exit_code)

    def stop(self, delays: StopDelays) -> None:
        """Record the request to stop."""
        self.stop_delays = delays

    def signal(self, number: int) -> None:
        """Record the signal."""
        self.signals.append(number)

    def kill(self) -> None:
        """Exit as after SIGKILL."""
        self.killed = True
        self._on_end(137)

    def reap(self) -> None:
        """Do nothing: the process exits when the test says so."""


class FakeRunner:
    """Starts fake processes and keeps the latest run of each by name."""

    def __init__(self, cannot_start: Sequence[str] = ()) -> None:
        self.children: dict[str, FakeChild] = {}
        self.started: list[str] = []
        """The names in the order of the starts, restarts included."""
        self.watched: dict[ProbedCondition, Callable[[], None]] = {}
        self.doomed: dict[ProbedCondition, Callable[[str], None]] = {}
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
        condition: ProbedCondition,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Keep the condition's callbacks.

        A test calls `watched[condition]` to meet the condition, and `doomed[condition]` with a
        reason to say that it can never be met.
        """
        self.watched[condition] = on_met
        self.doomed[condition] = on_failed
        return lambda: None

    def settled(self) -> None:
        """Record that the start-up is over."""
        self.is_settled = True


class RecordingScreen:
    """A screen for tests that keeps every line it is given."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.problems: list[str] = []
        self.ready_after_s: float | None = None
        self.summary: ReadySummary | None = None
        self.last_line: str | None = None

    def begin(self, names: Sequence[str], status: Callable[[], str]) -> None:
        """Do nothing."""

    def line(self, name: str, text: str) -> None:
        """Keep a line of a process as `[name] text`."""
        self.lines.append(f"[{name}] {text}")

    def note(self, text: str) -> None:
        """Keep a message of the supervisor."""
        self.lines.append(text)

    def problem(self, text: str) -> None:
        """Keep a problem."""
        self.lines.append(text)
        self.problems.append(text)

    def ready(self, elapsed_s: float, summary: ReadySummary) -> None:
        """Keep the time and the summary."""
        self.ready_after_s = elapsed_s
        self.summary = summary

    def refresh(self) -> None:
        """Do nothing."""

    def end(self, text: str, failed: bool) -> None:
        """Keep the last line."""
        self.last_line = text
