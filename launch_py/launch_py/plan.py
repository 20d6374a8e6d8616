"""What a launch description comes to: the steps to take, and what each of them waits for.

Actions are expanded into a `PlanBuilder`; `PlanBuilder.finish` checks the whole and returns the
`Plan` that the supervisor carries out. Nothing has been started until then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING

from launch_py.errors import LaunchFileError
from launch_py.near_names import describe_known
from launch_py.readiness import ProcessExited, Readiness
from launch_py.restart_policy import RestartPolicy

if TYPE_CHECKING:
    from launch_py.actions.action import Action
    from launch_py.events import ProcessEvent, ProcessIO, Shutdown

SIGTERM_TIMEOUT_S = 5.0
"""From SIGINT to SIGTERM, as ros2 launch has it."""

SIGKILL_TIMEOUT_S = 5.0
"""From SIGTERM to SIGKILL."""


class TriggerKind(Enum):
    """What another process must have done; the value completes "when it is ..."."""

    STARTED = "started"
    READY = "ready"
    EXITED = "ended"


@dataclass(frozen=True, slots=True)
class Trigger:
    """One thing that a step waits for; before `finish`, `process` may be an action."""

    kind: TriggerKind
    process: str | Action


@dataclass(frozen=True, slots=True)
class StopDelays:
    """How long a process may take after SIGINT, and then after SIGTERM, before the next signal."""

    sigterm_timeout_s: float = SIGTERM_TIMEOUT_S
    sigkill_timeout_s: float = SIGKILL_TIMEOUT_S


@dataclass(frozen=True, slots=True)
class GeneratedFile:
    """A file that a command line refers to, written when the process starts."""

    suffix: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One step of a plan, taken `delay_s` after all of `after` has happened."""

    after: tuple[Trigger, ...] = ()
    delay_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStep(Step):
    """Starts and supervises a process.

    `environment` holds only what the launch file sets, None for variables that it unsets; with
    `replace_environment` it is everything that the process gets. `shown` names the streams that
    go to the screen; all go to the log file. An empty `ready` means ready once started. `action`
    is what describes it in the launch file.
    """

    name: str
    command: tuple[str | GeneratedFile, ...]
    cwd: str | None = None
    environment: Mapping[str, str | None] = field(default_factory=dict)
    replace_environment: bool = False
    shown: frozenset[str] = frozenset({"stdout", "stderr"})
    emulate_tty: bool = False
    ready: tuple[Readiness, ...] = ()
    restart: RestartPolicy = field(default_factory=RestartPolicy)
    stop_delays: StopDelays = field(default_factory=StopDelays)
    action: Action | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageStep(Step):
    """Says something to the user."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ShutdownStep(Step):
    """Stops everything; the exit code is that of the process whose end triggered it."""

    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DeferredStep(Step):
    """Asks a function of the launch file, at its time, for the steps that follow."""

    expand: Callable[[ProcessEvent | None], Sequence[Step]]


@dataclass(frozen=True, slots=True, kw_only=True)
class ListeningStep(Step):
    """From its time on, asks a function of the launch file at every line of some processes.

    Before `finish`, a process may be an action; None are all processes.
    """

    processes: tuple[str | Action, ...] | None
    expand: Callable[[ProcessIO], Sequence[Step]]


@dataclass(frozen=True, slots=True, kw_only=True)
class FarewellStep(Step):
    """From its time on, it is said when everything is to stop what the function returns then."""

    expand: Callable[[Shutdown], Sequence[Step]]


@dataclass(frozen=True, slots=True)
class PanelEntry:
    """What the user is told when everything is ready; see `ReadyPanel`."""

    title: str | None
    topics: tuple[tuple[str, str], ...]
    commands: tuple[tuple[str, str], ...]
    notes: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """The steps in the order of the launch file, checked."""

    steps: tuple[Step, ...]
    panels: tuple[PanelEntry, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def processes(self) -> tuple[ProcessStep, ...]:
        """The steps that start processes."""
        return tuple(step for step in self.steps if isinstance(step, ProcessStep))

    def start_up(self) -> frozenset[str]:
        """Return the names of the processes that must be ready before the whole is ready.

        A process that waits for the end of a long-running one is a reaction, not start-up; one
        that waits for the end of a one-shot (ready when it has exited) belongs to it.
        """
        by_name = {step.name: step for step in self.processes}

        def counts(step: ProcessStep) -> bool:
            for trigger in step.after:
                target = by_name[str(trigger.process)]
                one_shot = any(isinstance(r, ProcessExited) for r in target.ready)
                if (trigger.kind is TriggerKind.EXITED and not one_shot) or not counts(target):
                    return False
            return True

        return frozenset(step.name for step in self.processes if counts(step))


class PlanBuilder:
    """Collects the steps while actions are expanded; belongs to one thread."""

    def __init__(self) -> None:
        self.surveyed_actions: set[Action] = set()
        """Every action of the description, also those that a condition switches off."""
        self.surveyed_names: set[str] = set()
        """The process names of those actions, as far as they are known without expanding."""
        self._steps: list[Step] = []
        self._panels: list[PanelEntry] = []
        self._warnings: list[str] = []
        self._names: dict[str, None] = {}
        self._for_each: list[tuple[Callable[[str], Step], set[str]]] = []
        self._processes_of: dict[Action, list[str]] = {}
        self._expanding: list[Action] = []
        self._finished = 0

    @contextmanager
    def expanding(self, action: Action) -> Iterator[None]:
        """Attribute the processes added inside to `action`, and to those around it."""
        self._expanding.append(action)
        self._processes_of.setdefault(action, [])
        try:
            yield
        finally:
            self._expanding.pop()

    @contextmanager
    def detached(self) -> Iterator[None]:
        """Attribute the processes added inside to none of the actions around.

        What an event handler starts may never start: whoever waits for a group, an include or a
        process must not wait for its handlers.
        """
        around, self._expanding = self._expanding, []
        try:
            yield
        finally:
            self._expanding = around

    def add(self, step: Step) -> None:
        """Add a step."""
        if isinstance(step, ProcessStep):
            step = replace(step, name=self._unique(step.name))
            for action in self._expanding:
                self._processes_of[action].append(step.name)
        self._steps.append(step)

    def add_for_each(self, make: Callable[[str], Step]) -> None:
        """Add the step that `make` returns for the name of each process, also of later ones."""
        self._for_each.append((make, set()))

    def add_panel(self, entry: PanelEntry) -> None:
        """Add a part of the ready panel."""
        self._panels.append(entry)

    def warn(self, text: str) -> None:
        """Note something that the user should know although the launch goes on."""
        self._warnings.append(text)

    def finish(self) -> Plan:
        """Return the plan, with all references between its steps resolved.

        Raises:
            LaunchFileError: a step waits for what is not there, or steps wait for each other.
        """
        return Plan(self.finish_steps(), tuple(self._panels), tuple(self._warnings))

    def finish_steps(self) -> tuple[Step, ...]:
        """Return the steps added since the last call, resolved; see `finish`."""
        for make, names in self._for_each:
            missing = [name for name in self._names if name not in names]
            self._steps += map(make, missing)
            names.update(missing)
        new = self._steps[self._finished :]
        resolved = [step for step in map(self._resolve, new) if step is not None]
        self._steps[self._finished :] = resolved
        self._steps = self._without_unreachable(self._steps)
        _refuse_cycles(self._steps)
        added = tuple(step for step in resolved if any(step is s for s in self._steps))
        # Only processes can be referred to later; there may be messages without end.
        self._steps = [step for step in self._steps if isinstance(step, ProcessStep)]
        self._finished = len(self._steps)
        return added

    def _unique(self, name: str) -> str:
        number, unique = 1, name
        while unique in self._names:
            number += 1
            unique = f"{name}-{number}"
        self._names[unique] = None
        return unique

    def _resolve(self, step: Step) -> Step | None:
        triggers: list[Trigger] = []
        for trigger in step.after:
            names = self._names_of(trigger.process, step)
            if not names and trigger.kind is not TriggerKind.READY:
                return None  # It waits for the start or end of something that is switched off.
            triggers.extend(Trigger(trigger.kind, name) for name in names)
        if isinstance(step, ListeningStep) and step.processes is not None:
            names = [name for target in step.processes for name in self._names_of(target, step)]
            step = replace(step, processes=tuple(names))
        return replace(step, after=tuple(dict.fromkeys(triggers)))

    def _names_of(self, target: str | Action, step: Step) -> list[str]:
        if not isinstance(target, str):
            if target in self._processes_of:
                return self._processes_of[target]
            if target in self.surveyed_actions:
                return []
            raise LaunchFileError(
                f"{describe_step(step)} waits for {target.describe()}, "
                "which is not part of the launch description"
            )
        if target in self._names:
            return [target]
        if target in self.surveyed_names:
            return []
        known = describe_known(target, self._names, "the processes are")
        raise LaunchFileError(
            f"{describe_step(step)} waits for unknown process {target!r}; {known}"
        )

    def _without_unreachable(self, steps: list[Step]) -> list[Step]:
        """Leave out what waits for a process that itself was left out."""
        while True:
            present = {step.name for step in steps if isinstance(step, ProcessStep)}
            kept = [s for s in steps if all(trigger.process in present for trigger in s.after)]
            if len(kept) == len(steps):
                return kept
            steps = kept


def describe_step(step: Step) -> str:
    """Return what to call a step in a message."""
    match step:
        case ProcessStep():
            return step.name
        case MessageStep():
            return f"the message {step.text!r}"
        case ShutdownStep():
            return "a shutdown"
        case _:
            return "an event handler"


def _refuse_cycles(steps: Sequence[Step]) -> None:
    waits_for = {
        step.name: [str(trigger.process) for trigger in step.after]
        for step in steps
        if isinstance(step, ProcessStep)
    }
    done: set[str] = set()

    def visit(name: str, path: tuple[str, ...]) -> None:
        if name in path:
            cycle = " waits for ".join([*path[path.index(name) :], name])
            raise LaunchFileError(f"nothing can start first: {cycle}")
        if name not in done:
            for other in waits_for[name]:
                visit(other, (*path, name))
            done.add(name)

    for name in waits_for:
        visit(name, ())
