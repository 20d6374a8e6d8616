"""Collects the steps of a plan while actions are expanded, and checks the plan.

Nothing is started until `PlanBuilder.finish` has returned the `LaunchPlan`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from launch_py.errors import LaunchFileError
from launch_py.events import LaunchDescriptionEntity
from launch_py.near_names import describe_known
from launch_py.plan.steps import (
    LaunchPlan,
    OutputHandlerStep,
    PanelEntry,
    ProcessStep,
    Step,
    Trigger,
    TriggerKind,
    describe_step,
)
from launch_py.substitution import LaunchScope


@dataclass(frozen=True, slots=True)
class ArgumentInfo:
    """A declared launch argument, for listings; it is required if `default` is None."""

    name: str
    default: str | None
    description: str | None
    choices: tuple[str, ...]
    launch_file: Path | None


@dataclass(slots=True)
class LaunchSurvey:
    """What all actions declare and contain, whatever their conditions say."""

    arguments: dict[str, ArgumentInfo] = field(default_factory=dict)
    actions: set[LaunchDescriptionEntity] = field(default_factory=set)
    process_names: set[str] = field(default_factory=set)

    def add_argument(self, argument: ArgumentInfo) -> None:
        """Add an argument. Of two with the same name the outer one is kept."""
        self.arguments.setdefault(argument.name, argument)


class PlanBuilder:
    """Collects the steps while actions are expanded; belongs to one thread."""

    def __init__(self) -> None:
        self.surveyed_actions: set[LaunchDescriptionEntity] = set()
        """Every action of the description, including those whose condition does not hold."""
        self.surveyed_names: set[str] = set()
        """The process names of those actions that are known without expanding them."""
        self.handlers_of_emitted_events: list[Callable[..., Any]] = []
        """The reactions `react(event, context)` of handlers that are for any event."""
        self._steps: list[Step] = []
        self._panels: list[PanelEntry] = []
        self._names: dict[str, None] = {}
        self._for_each: list[tuple[Callable[[str], Step], set[str]]] = []
        self._processes_of: dict[LaunchDescriptionEntity, list[str]] = {}
        self._expanding: list[LaunchDescriptionEntity] = []
        self._finished = 0

    @contextmanager
    def expanding(self, action: LaunchDescriptionEntity) -> Iterator[None]:
        """Attribute the processes added in this context to `action` and to its outer actions."""
        self._expanding.append(action)
        self._processes_of.setdefault(action, [])
        try:
            yield
        finally:
            self._expanding.pop()

    @contextmanager
    def detached(self) -> Iterator[None]:
        """Attribute the processes added in this context to no outer action.

        A process of an event handler may never start. A step that waits for a group, an include or
        a process must not wait for the processes of its handlers.
        """
        outer, self._expanding = self._expanding, []
        try:
            yield
        finally:
            self._expanding = outer

    def add(self, step: Step) -> None:
        """Add a step."""
        if isinstance(step, ProcessStep):
            step = replace(step, name=self._unique(step.name))
            for action in self._expanding:
                self._processes_of[action].append(step.name)
        self._steps.append(step)

    def add_for_each(self, make: Callable[[str], Step]) -> None:
        """Add the step that `make(name)` returns for each process, including later ones."""
        self._for_each.append((make, set()))

    def expanded_actions(self) -> list[LaunchDescriptionEntity]:
        """Return the actions that have been expanded so far, in that order."""
        return list(self._processes_of)

    def add_panel(self, entry: PanelEntry) -> None:
        """Add a part of the ready panel."""
        self._panels.append(entry)

    def finish(self, warnings: Sequence[str] = ()) -> LaunchPlan:
        """Return the plan, with all references between its steps resolved.

        Raises:
            LaunchFileError: a step waits for an unknown process, or steps wait for each other.
        """
        return LaunchPlan(self.finish_steps(), tuple(self._panels), tuple(warnings))

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
        # Later steps refer to processes only; the number of messages may grow without limit.
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
                return None  # It waits for the start or exit of a process that is switched off.
            triggers.extend(Trigger(trigger.kind, name) for name in names)
        if isinstance(step, OutputHandlerStep) and step.processes is not None:
            names = [name for target in step.processes for name in self._names_of(target, step)]
            step = replace(step, processes=tuple(names))
        return replace(step, after=tuple(dict.fromkeys(triggers)))

    def _names_of(self, target: str | LaunchDescriptionEntity, step: Step) -> list[str]:
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
        """Leave out the steps that wait for a process that was left out."""
        while True:
            present = {step.name for step in steps if isinstance(step, ProcessStep)}
            kept = [s for s in steps if all(trigger.process in present for trigger in s.after)]
            if len(kept) == len(steps):
                return kept
            steps = kept


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


@dataclass(slots=True)
class LaunchContext(LaunchScope):
    """The scope in which actions are expanded, and the plan that collects their steps.

    All copies of the context share the plan.
    """

    plan: PlanBuilder = field(default_factory=PlanBuilder)
    after: tuple[Trigger, ...] = ()
    """The events that the steps added in this scope wait for."""
    delay_s: float = 0.0
    """How long the steps wait after those events."""
