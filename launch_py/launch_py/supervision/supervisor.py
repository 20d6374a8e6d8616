"""Takes the steps of a plan when their time has come, and ends everything in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from launch_py.errors import LaunchError
from launch_py.events import ProcessEvent, Shutdown
from launch_py.plan import (
    DeferredStep,
    FarewellStep,
    ListeningStep,
    MessageStep,
    Plan,
    ProcessStep,
    ShutdownStep,
    Step,
    StopDelays,
    Trigger,
    TriggerKind,
)
from launch_py.readiness import ProcessExited
from launch_py.screen.screen import ReadySummary
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.late_calls import LIMIT_S, LateCalls, Outcome, outcome_of
from launch_py.supervision.member import Member, MemberState, ProcessRunner
from launch_py.supervision.process_events import exited_event, line_event, started_event
from launch_py.supervision.reporter import Reporter

EventT = TypeVar("EventT")

EXIT_NOT_READY = 1
EXIT_KILLED = 137
EXIT_FORCED = 130

REASON_IDLE = "idle"
"""Why handlers of the shutdown are told that it ends where everything has ended by itself, as in
ros2 launch."""

HASTY_DELAYS = StopDelays(sigterm_timeout_s=1.0, sigkill_timeout_s=1.0)
"""For an end that nobody watches any more: the launcher itself was killed."""


@dataclass(frozen=True, slots=True)
class Failure:
    """The first thing that went wrong, and the exit code that tells of it."""

    text: str
    exit_code: int


class Supervisor:
    """Carries out one plan; belongs to the loop's thread.

    Args:
        plan: what to do.
        loop: the event loop.
        runner: starts processes and probes conditions.
        reporter: says what happens.
        summary: what to say when everything is ready.
        started_s: the loop's time at which the launch began.
    """

    def __init__(
        self,
        plan: Plan,
        loop: EventLoop,
        runner: ProcessRunner,
        reporter: Reporter,
        summary: ReadySummary,
        started_s: float,
    ) -> None:
        self.members: dict[str, Member] = {}
        self.stopping = False
        self.failure: Failure | None = None
        self._plan = plan
        self._loop = loop
        self._runner = runner
        self._reporter = reporter
        self._summary = summary
        self._started_s = started_s
        self._start_up = plan.start_up()
        self._announced = not self._start_up
        self._pending: list[Step] = []
        self._listening: list[ListeningStep] = []
        self._farewells: list[FarewellStep] = []
        self._farewells_left = 0
        self._delayed = 0
        self._late_calls = LateCalls(loop, self._too_late)
        self._add(plan.steps)

    @property
    def done(self) -> bool:
        """Whether nothing runs and nothing more can happen."""
        if any(member.active for member in self.members.values()):
            return False
        if self.stopping:
            return not self._late_calls.busy
        return not (self._delayed or any(map(self._is_due, self._pending)))

    def begin(self) -> None:
        """Take the first steps."""
        self._reporter.begin(list(self.members), self.status)
        for warning in self._plan.warnings:
            self._reporter.problem(warning)
        self._advance()

    def stop(self, reason: str) -> None:
        """End everything, whatever depends on another process before that process."""
        if not self.stopping:
            self._reporter.note(f"stopping: {reason}")
            self._begin_to_end(reason)

    def rest(self) -> None:
        """Say farewell where everything has ended by itself; `done` is true again afterwards."""
        if not self.stopping:
            failed = [m for m in self.members.values() if m.exit_code]
            if failed:
                self._fail(Failure(f"{failed[0].name} {failed[0].ending}", failed[0].exit_code))
            self._begin_to_end(REASON_IDLE)

    def stop_hastily(self, reason: str) -> None:
        """End everything at once, with short delays before SIGKILL."""
        if not self.stopping:
            self.stopping = True
            self._pending.clear()
            self._reporter.note(f"stopping: {reason}")
        self._late_calls.give_up()
        for member in self._active():
            member.stop(HASTY_DELAYS)

    def kill(self, reason: str) -> None:
        """End everything now, by SIGKILL."""
        self.stopping = True
        self._pending.clear()
        self._late_calls.give_up()
        self._fail(Failure(reason, EXIT_FORCED))
        for member in self._active():
            member.kill()

    def reap(self) -> None:
        """Notice ended processes; to be called when SIGCHLD has come."""
        for member in list(self.members.values()):
            member.reap()

    def status(self) -> str:
        """Return how things stand, in one line."""
        running = [m for m in self.members.values() if m.state is MemberState.RUNNING]
        up_s = int(self._loop.clock() - self._started_s)
        facts = [f"up {up_s // 60}:{up_s % 60:02d}"]
        facts.append(f"{len(running)} process{'' if len(running) == 1 else 'es'}")
        if self.stopping and running:
            facts.append("stopping " + ", ".join(m.name for m in running))
        elif late := sorted(name for name in self._start_up if not self.members[name].ready):
            facts.append("waiting for " + ", ".join(late))
        facts += [member.status for member in running if member.status]
        return " · ".join(facts)

    def member_started(self, member: Member) -> None:
        """Take the steps that wait for the start."""
        pid = member.child.pid if member.child is not None else 0
        self._reporter.detail(f"{member.name} started, process {pid}")
        self._advance()

    def member_ready(self, member: Member) -> None:
        """Take the steps that wait for the readiness; say so when it was the last one."""
        if self.stopping:
            return
        if any(not isinstance(condition, ProcessExited) for condition in member.step.ready):
            elapsed_s = self._loop.clock() - self._started_s
            self._reporter.note(f"{member.name} is ready after {elapsed_s:.2f} s")
        self._advance()
        if not self._announced and all(self.members[name].ready for name in self._start_up):
            self._announced = True
            # Before the user knows: from then on anybody may kill a process.
            self._runner.settled()
            self._reporter.ready(self._loop.clock() - self._started_s, self._summary)

    def member_not_ready(self, member: Member, why: str) -> None:
        """Give up: what depends on the process could never start."""
        if self.stopping:
            return
        self._fail(Failure(f"{member.name} {why}", EXIT_NOT_READY))
        self.stop(f"{member.name} is not ready")

    def member_wrote(self, member: Member, stream: str, text: str) -> None:
        """Ask those who listen what follows."""
        for step in self._listening:
            heard = step.processes is None or member.name in step.processes
            if heard and not self.stopping:
                self._expand(step.expand, line_event(member, stream, text))

    def member_ended(self, member: Member) -> None:
        """Take the steps that wait for the end, or go on stopping."""
        text = f"{member.name} {member.ending}"
        if member.stopping:
            killed = member.child is not None and member.child.killed
            (self._reporter.problem if killed else self._reporter.note)(text)
            if killed:
                self._fail(Failure(text, EXIT_KILLED))
        else:
            (self._reporter.problem if member.exit_code else self._reporter.note)(text)
            self._check_ended(member, text)
        if self.stopping:
            self._stop_next()
        self._advance()

    def finish(self) -> int:
        """Return the exit code, after everything has ended; the last line names what failed."""
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
                self.members[step.name] = Member(
                    step, self._loop, self._runner, self._reporter, self
                )
            self._pending.append(step)

    def _active(self) -> list[Member]:
        return [member for member in self.members.values() if member.active]

    def _advance(self) -> None:
        """Take every step whose time has come.

        Taking one may call back into this method, so the list is looked at anew each time.
        """
        while (step := next(filter(self._is_due, self._pending), None)) is not None:
            self._pending.remove(step)
            if self.stopping:
                self._take_late(step)
            elif step.delay_s > 0.0:
                self._delayed += 1
                self._loop.call_later(step.delay_s, lambda s=step: self._take_delayed(s))
            else:
                self._take(step)

    def _is_due(self, step: Step) -> bool:
        return all(self._has_happened(trigger) for trigger in step.after)

    def _has_happened(self, trigger: Trigger) -> bool:
        member = self.members[str(trigger.process)]
        match trigger.kind:
            case TriggerKind.STARTED:
                return member.was_started
            case TriggerKind.READY:
                return member.ready
            case TriggerKind.EXITED:
                return member.state is MemberState.ENDED

    def _take_delayed(self, step: Step) -> None:
        self._delayed -= 1
        if not self.stopping:
            self._take(step)

    def _take(self, step: Step) -> None:
        match step:
            case ProcessStep():
                self.members[step.name].start()
            case MessageStep():
                self._reporter.note(step.text)
            case ShutdownStep():
                self._shut_down(step)
            case DeferredStep():
                self._expand(step.expand, self._event(step))
            case ListeningStep():
                self._listening.append(step)
            case FarewellStep():
                self._farewells.append(step)

    def _take_late(self, step: Step) -> None:
        """Take a step while everything stops: nothing is started, and nothing waited for."""
        match step:
            case ProcessStep():
                self._reporter.problem(f"{step.name} is not started: everything stops")
            case MessageStep() if not step.delay_s:
                self._reporter.note(step.text)
            case DeferredStep() if not step.delay_s:
                event = self._event(step)
                self._late_calls.call(lambda: step.expand(event), self._take_outcome)
            case _:
                pass

    def _take_outcome(self, outcome: Outcome) -> None:
        if isinstance(outcome, LaunchError):
            self._reporter.problem(str(outcome))
            return
        self._add(outcome)
        self._advance()

    def _too_late(self) -> None:
        self._reporter.problem(
            f"an event handler has not returned after {LIMIT_S:g} s: it is not waited for, and no "
            "other is called"
        )
        self._farewells_left = 0
        self._stop_next()

    def _shut_down(self, step: ShutdownStep) -> None:
        ended = [self.members[str(t.process)] for t in step.after if t.kind is TriggerKind.EXITED]
        for member in ended:
            if member.exit_code:
                self._fail(Failure(f"{member.name} {member.ending}", member.exit_code))
        reason = step.reason or " and ".join(f"{m.name} {m.ending}" for m in ended)
        self.stop(reason or "the launch file asks for it")

    def _expand(self, expand: Callable[[EventT], Sequence[Step]], event: EventT) -> None:
        outcome = outcome_of(lambda: expand(event))
        if isinstance(outcome, LaunchError):
            self._fail(Failure(str(outcome), EXIT_NOT_READY))
            self.stop("an event handler failed")
        else:
            self._add(outcome)
        self._advance()

    def _begin_to_end(self, reason: str) -> None:
        """Say farewell, then stop every process; from now on nothing is started."""
        self.stopping = True
        self._pending = [step for step in self._pending if _follows_an_end(step)]
        self._farewells_left = len(self._farewells)
        for member in self._active():
            member.restart_no_more()
        event = Shutdown(reason)
        for farewell in self._farewells:
            self._late_calls.call(lambda f=farewell: f.expand(event), self._take_farewell)
        self._stop_next()

    def _take_farewell(self, outcome: Outcome) -> None:
        if isinstance(outcome, LaunchError):
            self._fail(Failure(str(outcome), EXIT_NOT_READY))
        else:
            self._take_outcome(outcome)
        self._farewells_left -= 1
        self._stop_next()

    def _event(self, step: DeferredStep) -> ProcessEvent | None:
        """Return the event that the step's function is told of: the last one it waited for."""
        if not step.after:
            return None
        trigger = step.after[-1]
        member = self.members[str(trigger.process)]
        exited = trigger.kind is TriggerKind.EXITED
        return exited_event(member) if exited else started_event(member)

    def _check_ended(self, member: Member, text: str) -> None:
        """Fail where something can never happen because this process has ended."""
        if member.ready:
            return
        needed = any(
            trigger.process == member.name and trigger.kind is not TriggerKind.EXITED
            for step in self._pending
            for trigger in step.after
        )
        if member.step.ready or needed or not member.was_started:
            early = ", before it was ready" if member.missing() else ""
            # Of a process that failed, its own words are the reason, not what did not follow.
            missing = f": {member.missing()}" if early and not member.exit_code else ""
            self._fail(Failure(text + early + missing, member.exit_code or EXIT_NOT_READY))
            self.stop(f"{member.name} ended before it was ready")

    def _fail(self, failure: Failure) -> None:
        """Keep the first failure; the others follow from it."""
        if self.failure is None:
            self.failure = failure
            self._reporter.detail(f"failure: {failure.text}")

    def _stop_next(self) -> None:
        """Stop every process that no running one depends on, once all farewells are said."""
        if self._farewells_left:
            return
        active = self._active()
        needed = {str(t.process) for m in active for t in m.step.after}
        for member in active:
            if member.name not in needed and not member.stopping:
                member.stop()


def _follows_an_end(step: Step) -> bool:
    """Return whether the step may still be taken while everything stops."""
    return any(trigger.kind is TriggerKind.EXITED for trigger in step.after)
