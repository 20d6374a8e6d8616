"""One process of the plan over all its runs: readiness, restarts, stop."""

from __future__ import annotations

import re
from collections.abc import Callable
from enum import Enum
from typing import Protocol

from launch_py.errors import StartError
from launch_py.plan.readiness import Finished, LogLine, Notified, ProbedCondition, Readiness
from launch_py.plan.restart_policy import RestartHistory
from launch_py.plan.steps import ProcessStep, StopDelays
from launch_py.screen.reporter import Reporter
from launch_py.supervision.child_process import ChildSpec
from launch_py.supervision.event_loop import EventLoop, Timer

EXIT_CANNOT_START = 127
"""The exit code of a shell for a command that it cannot run."""


class ProcessState(Enum):
    """The state of a supervised process."""

    WAITING = "waiting"
    RUNNING = "running"
    BACKING_OFF = "waiting for its restart"
    ENDED = "ended"


class _ProcessListener(Protocol):
    """Receives the events of a process."""

    def process_started(self, process: ManagedProcess) -> None:
        """The process runs, for the first time or again."""
        ...

    def process_ready(self, process: ManagedProcess) -> None:
        """All readiness conditions of the process are met for the first time."""
        ...

    def process_not_ready(self, process: ManagedProcess, why: str) -> None:
        """The process is not ready in time, or can never be."""
        ...

    def process_wrote(self, process: ManagedProcess, stream: str, text: str) -> None:
        """The process has written a line to "stdout" or "stderr"."""
        ...

    def process_ended(self, process: ManagedProcess) -> None:
        """The process has ended and will not be restarted."""
        ...


class Child(Protocol):
    """A started process; see `ChildProcess`."""

    @property
    def pid(self) -> int:
        """The process id, which is also its session id and group id."""
        ...

    @property
    def killed(self) -> bool:
        """Whether it had to be ended by SIGKILL."""
        ...

    @property
    def spec(self) -> ChildSpec:
        """The specification that it was started with."""
        ...

    def stop(self, delays: StopDelays) -> None:
        """Stop it with SIGINT, then SIGTERM, then SIGKILL."""
        ...

    def signal(self, number: int) -> None:
        """Send it a signal."""
        ...

    def kill(self) -> None:
        """Kill it now."""
        ...

    def reap(self) -> None:
        """Check whether it has ended."""
        ...


class ProcessRunner(Protocol):
    """Starts processes and watches their probed conditions."""

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
        condition: ProbedCondition,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back once the condition is met or can never be; return a function to stop that."""
        ...

    def settled(self) -> None:
        """Release the resources of the start-up. Called when everything is ready."""
        ...


class ManagedProcess:
    """Supervises one process; belongs to the loop's thread."""

    def __init__(
        self,
        step: ProcessStep,
        loop: EventLoop,
        runner: ProcessRunner,
        reporter: Reporter,
        listener: _ProcessListener,
    ) -> None:
        self.step = step
        self.state = ProcessState.WAITING
        self.ready = False
        self.was_started = False
        self.stopping = False
        self.exit_code = 0
        self.ending = ""
        """How it ended: the predicate of a sentence whose subject is its name."""
        self.status = ""
        """The last STATUS that it sent; see `NotifySocket`."""
        self.remark = ""
        """The last X_REMARK that it sent. It is shown once everything is ready."""
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
        """The process's name."""
        return self.step.name

    @property
    def active(self) -> bool:
        """Whether it runs, or will run again."""
        return self.state in (ProcessState.RUNNING, ProcessState.BACKING_OFF)

    def missing(self) -> str:
        """Return which readiness conditions are not met."""
        return " and ".join(condition.missing() for condition in self._pending)

    def start(self) -> None:
        """Start the process."""
        self._history.started()
        self._started_s = self._loop.clock()
        try:
            self.child = self._runner.start(self.step, self._on_line, self._on_end)
        except StartError as error:
            self.state = ProcessState.ENDED
            self.exit_code = EXIT_CANNOT_START
            self.ending = f"could not be started: {error}"
            self._listener.process_ended(self)
            return
        self.state = ProcessState.RUNNING
        self.was_started = True
        self._listener.process_started(self)
        if not self.ready and not self.stopping:
            self._await_readiness()

    def disable_restart(self) -> None:
        """Do not restart it any more; cancel a restart that is due."""
        self._last_run = True
        if self.state is ProcessState.BACKING_OFF:
            self.stop()

    def stop(self, delays: StopDelays | None = None) -> None:
        """Stop it by signals; cancel a restart that is due."""
        self.stopping = True
        if self.state is ProcessState.BACKING_OFF:
            self._end_for_good("was stopped")
        elif self.state is ProcessState.RUNNING and self.child is not None:
            self._stop_watching()
            self.child.stop(delays or self.step.stop_delays)

    def signal(self, number: int | None) -> None:
        """Send a signal if it runs; None stops it."""
        if number is None:
            self.disable_restart()
            self.stop()
        elif self.state is ProcessState.RUNNING and self.child is not None:
            self.child.signal(number)

    def kill(self) -> None:
        """Kill it now."""
        self.stopping = True
        self._killed = True
        if self.state is ProcessState.BACKING_OFF:
            self._end_for_good("was stopped")
        elif self.child is not None:
            self._stop_watching()
            self.child.kill()

    def reap(self) -> None:
        """Check whether it has ended. Call it after SIGCHLD."""
        if self.child is not None:
            self.child.reap()

    def notified(self, fields: dict[str, str]) -> None:
        """Handle a notification from the process or one of its descendants."""
        self.status = fields.get("STATUS", self.status)
        self.remark = fields.get("X_REMARK", self.remark)
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
            if isinstance(condition, ProbedCondition):
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
        self._listener.process_ready(self)

    def _never_met(self, condition: Readiness, why: str) -> None:
        if condition in self._pending:
            self._listener.process_not_ready(self, f"cannot become ready: {why}")

    def _too_late(self, condition: Readiness) -> None:
        if condition in self._pending:
            self._listener.process_not_ready(
                self, f"is not ready after {condition.timeout_s:g} s: {self.missing()}"
            )

    def _stop_watching(self) -> None:
        cancel, self._cancel = self._cancel, []
        for stop_watching in cancel:
            stop_watching()

    def _on_line(self, stream: str, text: str) -> None:
        # Hides the traceback of a Python process that is interrupted while it starts.
        interrupted = self.stopping and not self.ready
        self._reporter.line(self.name, text, shown=stream in self.step.shown and not interrupted)
        for condition, pattern in list(self._patterns.items()):
            if pattern.search(text):
                self._met(condition)
        self._listener.process_wrote(self, stream, text)

    def _on_end(self, exit_code: int) -> None:
        self._stop_watching()
        self.exit_code = exit_code
        if self.stopping:
            self._end_for_good(self._describe_stop())
            return
        for condition in [c for c in self._pending if isinstance(c, Finished)]:
            if condition.code == exit_code:
                self._met(condition)
        ending = f"{describe_exit(exit_code)} after {self._loop.clock() - self._started_s:.2f} s"
        decision = self._history.ended(exit_code)
        if decision.delay_s is None or self._last_run:
            why = f"; giving up: {decision.gave_up}" if decision.gave_up else ""
            self._end_for_good(ending + why)
            return
        self.state = ProcessState.BACKING_OFF
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
        self.state = ProcessState.ENDED
        self.ending = ending
        self._listener.process_ended(self)


def describe_exit(exit_code: int) -> str:
    """Return how a process ended, to follow its name in a sentence."""
    import signal

    if exit_code > 128:
        try:
            return f"was killed by {signal.Signals(exit_code - 128).name}"
        except ValueError:
            pass
    return f"ended with exit code {exit_code}"
