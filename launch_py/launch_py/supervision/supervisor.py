"""Executes a plan: takes each step when it is due, and stops everything in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from launch_py.errors import LaunchError
from launch_py.events import ShutdownEvent
from launch_py.plan.readiness import Finished
from launch_py.plan.steps import (
    DeferredStep,
    LaunchPlan,
    MessageStep,
    OutputHandlerStep,
    ProcessStep,
    ShutdownHandlerStep,
    ShutdownStep,
    SignalStep,
    Step,
    StopDelays,
    Trigger,
    TriggerKind,
)
from launch_py.screen.reporter import Reporter
from launch_py.screen.screen import ReadySummary
from launch_py.supervision.event_handling import (
    HANDLER_TIMEOUT_S,
    HandlerResult,
    HandlerThread,
    awaited_event,
    call_handler,
    line_event,
    started_event,
)
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.managed_process import ManagedProcess, ProcessRunner, ProcessState


class StepSchedule:
    """Returns each step once all its triggers have happened; belongs to the loop's thread."""

    def __init__(self, loop: EventLoop, has_happened: Callable[[Trigger], bool]) -> None:
        self._loop = loop
        self._has_happened = has_happened
        self._waiting: list[Step] = []
        self._delayed = 0

    @property
    def open(self) -> bool:
        """Whether a step is due now or after its delay."""
        return bool(self._delayed) or any(map(self._is_due, self._waiting))

    def add(self, step: Step) -> None:
        """Add a step."""
        self._waiting.append(step)

    def next_due(self) -> Step | None:
        """Remove and return the first step that is due, or None."""
        step = next(filter(self._is_due, self._waiting), None)
        if step is not None:
            self._waiting.remove(step)
        return step

    def delay(self, step: Step, take: Callable[[Step], None]) -> None:
        """Call `take` with a step that is due, after the step's delay."""
        self._delayed += 1

        def elapsed() -> None:
            self._delayed -= 1
            take(step)

        self._loop.call_later(step.delay_s, elapsed)

    def needs(self, process: str) -> bool:
        """Return whether a step waits for the start or the readiness of a process."""
        return any(
            trigger.process == process and trigger.kind is not TriggerKind.EXITED
            for step in self._waiting
            for trigger in step.after
        )

    def keep_reactions_to_exits(self) -> None:
        """Drop every step that does not wait for the end of a process."""
        self._waiting = [step for step in self._waiting if _awaits_exit(step.after)]

    def clear(self) -> None:
        """Drop every waiting step."""
        self._waiting.clear()

    def _is_due(self, step: Step) -> bool:
        return all(map(self._has_happened, step.after))


def _awaits_exit(triggers: Iterable[Trigger]) -> bool:
    return any(trigger.kind is TriggerKind.EXITED for trigger in triggers)


EventT = TypeVar("EventT")

EXIT_NOT_READY = 1
EXIT_KILLED = 137
EXIT_FORCED = 130

REASON_IDLE = "idle"
"""The reason of the shutdown event if every process has ended by itself, as in ros2 launch."""

SHORT_DELAYS = StopDelays(sigterm_timeout_s=1.0, sigkill_timeout_s=1.0)
"""Used when the launcher itself was killed, and nobody waits for an orderly shutdown."""


@dataclass(frozen=True, slots=True)
class LaunchFailure:
    """The first failure of a launch, and the exit code that reports it."""

    text: str
    exit_code: int


class Supervisor:
    """Executes one plan; belongs to the loop's thread.

    `started_s` is the loop's time at which the launch began, and `summary` is shown when everything
    is ready.
    """

    def __init__(
        self,
        plan: LaunchPlan,
        loop: EventLoop,
        runner: ProcessRunner,
        reporter: Reporter,
        summary: ReadySummary,
        started_s: float,
    ) -> None:
        self.processes: dict[str, ManagedProcess] = {}
        self.stopping = False
        self.failure: LaunchFailure | None = None
        self._plan = plan
        self._loop = loop
        self._runner = runner
        self._reporter = reporter
        self._summary = summary
        self._started_s = started_s
        self._start_up = plan.start_up()
        self._announced = not self._start_up
        self._schedule = StepSchedule(loop, self._has_happened)
        self._output_handlers: list[OutputHandlerStep] = []
        self._shutdown_handlers: list[ShutdownHandlerStep] = []
        self._shutdown_handlers_left = 0
        self._handler_thread = HandlerThread(loop, self._handler_timed_out)
        self._add(plan.steps)

    @property
    def done(self) -> bool:
        """Whether no process runs and no step can follow."""
        if any(process.active for process in self.processes.values()):
            return False
        if self.stopping:
            return not self._handler_thread.busy
        return not self._schedule.open

    def begin(self) -> None:
        """Take the first steps."""
        self._reporter.begin(list(self.processes), self.status)
        for warning in self._plan.warnings:
            self._reporter.problem(warning)
        self._advance()

    def stop(self, reason: str) -> None:
        """Stop everything; a process that depends on another one stops first."""
        if not self.stopping:
            self._reporter.note(f"stopping: {reason}")
            self._begin_shutdown(reason)

    def refuse(self, why: str) -> None:
        """Fail because a node's name is taken, and stop what has been started."""
        if not self.stopping:
            self._fail(LaunchFailure(why, EXIT_NOT_READY))
            if any(process.was_started for process in self.processes.values()):
                self.stop("two nodes have the same name")
            else:
                self.stopping = True
                self._schedule.clear()

    def finish_idle(self) -> None:
        """Call the shutdown handlers after every process has ended by itself.

        `done` is false until they have returned.
        """
        if not self.stopping:
            failed = [p for p in self.processes.values() if p.exit_code]
            if failed:
                self._fail(
                    LaunchFailure(f"{failed[0].name} {failed[0].ending}", failed[0].exit_code)
                )
            self._begin_shutdown(REASON_IDLE)

    def stop_quickly(self, reason: str) -> None:
        """Stop every process at once, with short delays before SIGKILL."""
        if not self.stopping:
            self.stopping = True
            self._schedule.clear()
            self._reporter.note(f"stopping: {reason}")
        self._handler_thread.give_up()
        for process in self._active():
            process.stop(SHORT_DELAYS)

    def kill(self, reason: str) -> None:
        """Kill every process now, by SIGKILL."""
        self.stopping = True
        self._schedule.clear()
        self._handler_thread.give_up()
        self._fail(LaunchFailure(reason, EXIT_FORCED))
        for process in self._active():
            process.kill()

    def reap(self) -> None:
        """Check which processes have ended. Call it after SIGCHLD."""
        for process in list(self.processes.values()):
            process.reap()

    def status(self) -> str:
        """Return the status line."""
        running = [p for p in self.processes.values() if p.state is ProcessState.RUNNING]
        up_s = int(self._loop.clock() - self._started_s)
        facts = [f"up {up_s // 60}:{up_s % 60:02d}"]
        facts.append(f"{len(running)} process{'' if len(running) == 1 else 'es'}")
        if self.stopping and running:
            facts.append("stopping " + ", ".join(p.name for p in running))
        elif late := sorted(name for name in self._start_up if not self.processes[name].ready):
            facts.append("waiting for " + ", ".join(late))
        facts += [process.status for process in running if process.status]
        return " · ".join(facts)

    def process_started(self, process: ManagedProcess) -> None:
        """Take the steps that wait for the start."""
        pid = process.child.pid if process.child is not None else 0
        self._reporter.detail(f"{process.name} started, process {pid}")
        self._advance()

    def process_ready(self, process: ManagedProcess) -> None:
        """Take the steps that wait for it. Report when everything is ready."""
        if self.stopping:
            return
        if any(not isinstance(condition, Finished) for condition in process.step.ready):
            elapsed_s = self._loop.clock() - self._started_s
            self._reporter.note(f"{process.name} is ready after {elapsed_s:.2f} s")
        self._advance()
        if not self._announced and all(self.processes[name].ready for name in self._start_up):
            self._announced = True
            # This comes before the report, because a user may kill a process right after it.
            self._runner.settled()
            remarks = [(p.name, p.remark) for p in self.processes.values() if p.remark]
            summary = replace(self._summary, notes=(*self._summary.notes, *remarks))
            self._reporter.ready(self._loop.clock() - self._started_s, summary)

    def process_not_ready(self, process: ManagedProcess, why: str) -> None:
        """Stop everything, because the processes that depend on this one can never start."""
        if self.stopping:
            return
        self._fail(LaunchFailure(f"{process.name} {why}", EXIT_NOT_READY))
        self.stop(f"{process.name} is not ready")

    def process_wrote(self, process: ManagedProcess, stream: str, text: str) -> None:
        """Call the output handlers of the process."""
        for step in self._output_handlers:
            handles = step.processes is None or process.name in step.processes
            if handles and not self.stopping:
                self._expand(step.expand, line_event(process, stream, text))

    def process_ended(self, process: ManagedProcess) -> None:
        """Take the steps that wait for the end, or stop the next process."""
        text = f"{process.name} {process.ending}"
        if process.stopping:
            killed = process.child is not None and process.child.killed
            (self._reporter.problem if killed else self._reporter.note)(text)
            if killed:
                self._fail(LaunchFailure(text, EXIT_KILLED))
        else:
            (self._reporter.problem if process.exit_code else self._reporter.note)(text)
            self._check_ended(process, text)
        if self.stopping:
            self._stop_next()
        self._advance()

    def finish(self) -> int:
        """Show the last line, which names the failure, and return the exit code."""
        elapsed_s = self._loop.clock() - self._started_s
        if self.failure is None:
            self._reporter.end(f"stopped after {elapsed_s:.2f} s", failed=False)
            return 0
        code = self.failure.exit_code
        self._reporter.end(f"failed with exit code {code}: {self.failure.text}", failed=True)
        return code

    def _add(self, steps: Iterable[Step]) -> None:
        for step in steps:
            if isinstance(step, ProcessStep):
                self.processes[step.name] = ManagedProcess(
                    step, self._loop, self._runner, self._reporter, self
                )
            self._schedule.add(step)

    def _active(self) -> list[ManagedProcess]:
        return [process for process in self.processes.values() if process.active]

    def _advance(self) -> None:
        """Take every step that is due.

        Taking a step may call this method again, so the loop asks the schedule each time.
        """
        while (step := self._schedule.next_due()) is not None:
            if self.stopping:
                self._take_while_stopping(step)
            elif step.delay_s > 0.0:
                self._schedule.delay(step, self._take_delayed)
            else:
                self._take(step)

    def _has_happened(self, trigger: Trigger) -> bool:
        process = self.processes[str(trigger.process)]
        match trigger.kind:
            case TriggerKind.STARTED:
                return process.was_started
            case TriggerKind.READY:
                return process.ready
            case TriggerKind.EXITED:
                return process.state is ProcessState.ENDED

    def _take_delayed(self, step: Step) -> None:
        if not self.stopping:
            self._take(step)

    def _take(self, step: Step) -> None:
        match step:
            case ProcessStep():
                self.processes[step.name].start()
            case MessageStep():
                self._reporter.note(step.text)
            case ShutdownStep():
                self._shut_down(step)
            case SignalStep():
                for process in self._active():
                    if step.concerns(started_event(process)):
                        process.signal(step.signal_number)
            case DeferredStep():
                self._expand(step.expand, awaited_event(step, self.processes))
            case OutputHandlerStep():
                self._output_handlers.append(step)
            case ShutdownHandlerStep():
                self._shutdown_handlers.append(step)

    def _take_while_stopping(self, step: Step) -> None:
        """Take a step during the shutdown, which starts no process and waits for no delay."""
        match step:
            case ProcessStep():
                self._reporter.problem(f"{step.name} is not started: the launch is stopping")
            case MessageStep() if not step.delay_s:
                self._reporter.note(step.text)
            case DeferredStep() if not step.delay_s:
                event = awaited_event(step, self.processes)
                self._handler_thread.call(lambda: step.expand(event), self._take_result)
            case _:
                pass

    def _take_result(self, outcome: HandlerResult) -> None:
        if isinstance(outcome, LaunchError):
            self._reporter.problem(str(outcome))
            return
        self._add(outcome)
        self._advance()

    def _handler_timed_out(self) -> None:
        self._reporter.problem(
            f"an event handler has not returned after {HANDLER_TIMEOUT_S:g} s; "
            "the launcher stops waiting for it and calls no other handler"
        )
        self._shutdown_handlers_left = 0
        self._stop_next()

    def _shut_down(self, step: ShutdownStep) -> None:
        ended = [self.processes[str(t.process)] for t in step.after if t.kind is TriggerKind.EXITED]
        for process in ended:
            if process.exit_code:
                self._fail(LaunchFailure(f"{process.name} {process.ending}", process.exit_code))
        reason = step.reason or " and ".join(f"{p.name} {p.ending}" for p in ended)
        self.stop(reason or "the launch file asks for it")

    def _expand(self, expand: Callable[[EventT], Sequence[Step]], event: EventT) -> None:
        outcome = call_handler(lambda: expand(event))
        if isinstance(outcome, LaunchError):
            self._fail(LaunchFailure(str(outcome), EXIT_NOT_READY))
            self.stop("an event handler failed")
        else:
            self._add(outcome)
        self._advance()

    def _begin_shutdown(self, reason: str) -> None:
        """Call the shutdown handlers, then stop every process. Nothing is started from now on."""
        self.stopping = True
        self._schedule.keep_reactions_to_exits()
        self._shutdown_handlers_left = len(self._shutdown_handlers)
        for process in self._active():
            process.disable_restart()
        event = ShutdownEvent(reason)
        for handler in self._shutdown_handlers:
            self._handler_thread.call(lambda h=handler: h.expand(event), self._take_shutdown_result)
        self._stop_next()

    def _take_shutdown_result(self, outcome: HandlerResult) -> None:
        if isinstance(outcome, LaunchError):
            self._fail(LaunchFailure(str(outcome), EXIT_NOT_READY))
        else:
            self._take_result(outcome)
        self._shutdown_handlers_left -= 1
        self._stop_next()

    def _check_ended(self, process: ManagedProcess, text: str) -> None:
        """Fail if a step or a readiness condition can no longer be met after this exit."""
        if process.ready:
            return
        needed = self._schedule.needs(process.name)
        if process.step.ready or needed or not process.was_started:
            early = ", before it was ready" if process.missing() else ""
            # If the process failed, its exit code is the reason, not the unmet condition.
            missing = f": {process.missing()}" if early and not process.exit_code else ""
            self._fail(LaunchFailure(text + early + missing, process.exit_code or EXIT_NOT_READY))
            self.stop(f"{process.name} ended before it was ready")

    def _fail(self, failure: LaunchFailure) -> None:
        """Keep the first failure. Later ones follow from it."""
        if self.failure is None:
            self.failure = failure
            self._reporter.detail(f"failure: {failure.text}")

    def _stop_next(self) -> None:
        """Stop every process that no running process needs, once the shutdown handlers returned."""
        if self._shutdown_handlers_left:
            return
        active = self._active()
        needed = {str(t.process) for p in active for t in p.step.after}
        for process in active:
            if process.name not in needed and not process.stopping:
                process.stop()
