"""One process of the plan over all its runs: readiness, restarts, stop."""

from __future__ import annotations

import re
from collections.abc import Callable
from enum import Enum
from typing import Protocol

from launch_py.errors import StartError
from launch_py.plan import ProcessStep, StopDelays
from launch_py.readiness import LogLine, Notified, Probe, ProcessExited, Readiness
from launch_py.restart_policy import RestartHistory
from launch_py.supervision.child_process import ChildSpec
from launch_py.supervision.event_loop import EventLoop, Timer
from launch_py.supervision.reporter import Reporter

EXIT_CANNOT_START = 127
"""The exit code of a shell for a command that it cannot run."""


class MemberState(Enum):
    """Where a process is in its life."""

    WAITING = "waiting"
    RUNNING = "running"
    BACKING_OFF = "waiting for its restart"
    ENDED = "ended"


class MemberListener(Protocol):
    """Who is told what happens to a process."""

    def member_started(self, member: Member) -> None:
        """The process runs, for the first time or again."""
        ...

    def member_ready(self, member: Member) -> None:
        """All its conditions of readiness have been met, for the first time."""
        ...

    def member_not_ready(self, member: Member, why: str) -> None:
        """It is not ready within its time, or can never be."""
        ...

    def member_wrote(self, member: Member, stream: str, text: str) -> None:
        """It has written a line to "stdout" or "stderr"."""
        ...

    def member_ended(self, member: Member) -> None:
        """It has ended and will not be restarted."""
        ...


class Child(Protocol):
    """A started process; see `ChildProcess`."""

    @property
    def pid(self) -> int:
        """The process id, also that of its session and group."""
        ...

    @property
    def killed(self) -> bool:
        """Whether it had to be ended by SIGKILL."""
        ...

    @property
    def spec(self) -> ChildSpec:
        """What was started."""
        ...

    def stop(self, delays: StopDelays) -> None:
        """Ask it to end, with signals of growing force."""
        ...

    def kill(self) -> None:
        """End it now."""
        ...

    def reap(self) -> None:
        """Notice whether it has ended."""
        ...


class ProcessRunner(Protocol):
    """Starts processes and watches conditions from outside them."""

    def start(
        self,
        step: ProcessStep,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
    ) -> Child:
        """Start the process of a step; raises StartError."""
        ...

    def watch(
        self,
        step: ProcessStep,
        condition: Probe,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back once the condition is met, or can never be; return how to stop watching."""
        ...

    def settled(self) -> None:
        """Release what only the start-up needs: everything is ready."""
        ...


class Member:
    """Supervises one process; belongs to the loop's thread."""

    def __init__(
        self,
        step: ProcessStep,
        loop: EventLoop,
        runner: ProcessRunner,
        reporter: Reporter,
        listener: MemberListener,
    ) -> None:
        self.step = step
        self.state = MemberState.WAITING
        self.ready = False
        self.was_started = False
        self.stopping = False
        self.exit_code = 0
        self.ending = ""
        """How it ended, to be put after its name in a sentence."""
        self.status = ""
        """What it last said of itself; see `NotifySocket`."""
        self.child: Child | None = None
        self._loop = loop
        self._runner = runner
        self._reporter = reporter
        self._listener = listener
        self._history = RestartHistory(step.restart, loop.clock)
        self._pending: list[Readiness] = []
        self._patterns: dict[LogLine, re.Pattern[str]] = {}
        self._cancel: list[Callable[[], None]] = []
        self._restart_timer: Timer | None = None
        self._started_s = 0.0
        self._killed = False
        self._last_run = False

    @property
    def name(self) -> str:
        """What the process is called."""
        return self.step.name

    @property
    def active(self) -> bool:
        """Whether it runs, or will run again."""
        return self.state in (MemberState.RUNNING, MemberState.BACKING_OFF)

    def missing(self) -> str:
        """Return what is missing for it to be ready."""
        return " and ".join(condition.missing() for condition in self._pending)

    def start(self) -> None:
        """Start the process."""
        self._history.started()
        self._started_s = self._loop.clock()
        try:
            self.child = self._runner.start(self.step, self._on_line, self._on_end)
        except StartError as error:
            self.state = MemberState.ENDED
            self.exit_code = EXIT_CANNOT_START
            self.ending = f"could not be started: {error}"
            self._listener.member_ended(self)
            return
        self.state = MemberState.RUNNING
        self.was_started = True
        self._listener.member_started(self)
        if not self.ready and not self.stopping:
            self._await_readiness()

    def restart_no_more(self) -> None:
        """Let this run be the last: a restart that is due does not happen."""
        self._last_run = True
        if self.state is MemberState.BACKING_OFF:
            self.stop()

    def stop(self, delays: StopDelays | None = None) -> None:
        """Ask it to end, first politely; a restart that is due does not happen."""
        self.stopping = True
        if self.state is MemberState.BACKING_OFF:
            self._end_for_good("was stopped")
        elif self.state is MemberState.RUNNING and self.child is not None:
            self._stop_watching()
            self.child.stop(delays or self.step.stop_delays)

    def kill(self) -> None:
        """End it now."""
        self.stopping = True
        self._killed = True
        if self.state is MemberState.BACKING_OFF:
            self._end_for_good("was stopped")
        elif self.child is not None:
            self._stop_watching()
            self.child.kill()

    def reap(self) -> None:
        """Notice whether it has ended; to be called when SIGCHLD has come."""
        if self.child is not None:
            self.child.reap()

    def notified(self, fields: dict[str, str]) -> None:
        """Take a notification that the process or a descendant of it has sent."""
        self.status = fields.get("STATUS", self.status)
        if fields.get("READY") == "1":
            for condition in [c for c in self._pending if isinstance(c, Notified)]:
                self._met(condition)

    def _await_readiness(self) -> None:
        self._pending = list(self.step.ready)
        self._patterns = {c: re.compile(c.pattern) for c in self._pending if isinstance(c, LogLine)}
        if not self._pending:
            self._become_ready()
        for condition in self.step.ready:
            timer = self._loop.call_later(
                condition.timeout_s, lambda c=condition: self._too_late(c)
            )
            self._cancel.append(timer.cancel)
            if isinstance(condition, Probe):
                self._cancel.append(
                    self._runner.watch(
                        self.step,
                        condition,
                        lambda c=condition: self._met(c),
                        lambda why, c=condition: self._never_met(c, why),
                    )
                )

    def _met(self, condition: Readiness) -> None:
        if condition in self._pending:
            self._pending.remove(condition)
            self._patterns = {c: p for c, p in self._patterns.items() if c in self._pending}
            if not self._pending:
                self._become_ready()

    def _become_ready(self) -> None:
        self._stop_watching()
        self.ready = True
        self._listener.member_ready(self)

    def _never_met(self, condition: Readiness, why: str) -> None:
        if condition in self._pending:
            self._listener.member_not_ready(self, f"cannot become ready: {why}")

    def _too_late(self, condition: Readiness) -> None:
        if condition in self._pending:
            self._listener.member_not_ready(
                self, f"is not ready after {condition.timeout_s:g} s: {self.missing()}"
            )

    def _stop_watching(self) -> None:
        cancel, self._cancel = self._cancel, []
        for stop_watching in cancel:
            stop_watching()

    def _on_line(self, stream: str, text: str) -> None:
        # What a Python says that is interrupted at its start is of no use to anybody.
        given_up = self.stopping and not self.ready
        self._reporter.line(self.name, text, shown=stream in self.step.shown and not given_up)
        for condition, pattern in list(self._patterns.items()):
            if pattern.search(text):
                self._met(condition)
        self._listener.member_wrote(self, stream, text)

    def _on_end(self, exit_code: int) -> None:
        self._stop_watching()
        self.exit_code = exit_code
        if self.stopping:
            self._end_for_good(self._describe_stop())
            return
        for condition in [c for c in self._pending if isinstance(c, ProcessExited)]:
            if condition.code == exit_code:
                self._met(condition)
        ending = f"{describe_exit(exit_code)} after {self._loop.clock() - self._started_s:.2f} s"
        decision = self._history.ended(exit_code)
        if decision.delay_s is None or self._last_run:
            why = f"; giving up: {decision.gave_up}" if decision.gave_up else ""
            self._end_for_good(ending + why)
            return
        self.state = MemberState.BACKING_OFF
        self._reporter.problem(f"{self.name} {ending}; restart in {decision.delay_s:g} s")
        self._restart_timer = self._loop.call_later(decision.delay_s, self.start)

    def _describe_stop(self) -> str:
        if self._killed:
            return "was killed"
        hung = self.child is not None and self.child.killed
        return "did not stop and was killed" if hung else "stopped"

    def _end_for_good(self, ending: str) -> None:
        if self._restart_timer is not None:
            self._restart_timer.cancel()
        self.state = MemberState.ENDED
        self.ending = ending
        self._listener.member_ended(self)


def describe_exit(exit_code: int) -> str:
    """Return how a process ended, to be put after its name in a sentence."""
    import signal

    if exit_code > 128:
        try:
            return f"was killed by {signal.Signals(exit_code - 128).name}"
        except ValueError:
            pass
    return f"ended with exit code {exit_code}"
