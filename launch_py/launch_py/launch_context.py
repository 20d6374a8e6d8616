"""What a launch file sees while it is expanded: arguments, environment, namespace, remappings."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from launch_py.actions.action import Action, check_actions
from launch_py.child_environment import for_program
from launch_py.errors import blaming
from launch_py.events import ProcessEvent
from launch_py.names import join_names
from launch_py.plan import DeferredStep, PlanBuilder, Step, Trigger
from launch_py.substitution import Text, perform_text

EventT = TypeVar("EventT")
DeferredFunction = Callable[[EventT, "LaunchContext"], Iterable[Action] | Action | None]


@dataclass(slots=True)
class LaunchContext:
    """The scope in which actions are expanded.

    Groups and includes work on a copy (`scoped`): what they set does not leak to what follows
    them. The plan is shared by all scopes.
    """

    plan: PlanBuilder = field(default_factory=PlanBuilder)
    launch_configurations: dict[str, str] = field(default_factory=dict)
    base_environment: Mapping[str, str] = field(default_factory=lambda: dict(os.environ))
    environment: dict[str, str | None] = field(default_factory=dict)
    """Variables that the launch file set, None for those that it unset."""
    namespace: str = ""
    parameters: list[dict[str, Any] | str] = field(default_factory=list)
    """What all nodes of this scope get before their own: dicts, and paths of parameter files."""
    remappings: list[tuple[str, str]] = field(default_factory=list)
    after: tuple[Trigger, ...] = ()
    delay_s: float = 0.0
    """What the steps added in this scope wait for, and how long after that."""
    event: object = None
    """What has happened, for the actions that are expanded then; see `LocalSubstitution`."""
    launch_file: Path | None = None
    included_files: tuple[Path, ...] = ()
    """The launch files around this scope, outermost first."""
    fixed_arguments: frozenset[str] = frozenset()
    """Arguments whose values an include around this scope sets."""

    def scoped(self) -> LaunchContext:
        """Return a copy whose changes stay inside it."""
        return replace(
            self,
            launch_configurations=dict(self.launch_configurations),
            environment=dict(self.environment),
            parameters=list(self.parameters),
            remappings=list(self.remappings),
        )

    def bare(self) -> LaunchContext:
        """Return a copy without what was set so far."""
        return replace(
            self,
            launch_configurations={},
            environment={},
            namespace="",
            parameters=[],
            remappings=[],
        )

    def included(self, path: Path | None, arguments: Mapping[str, str]) -> LaunchContext:
        """Return the scope of a file that is included here with these arguments."""
        inner = self.scoped()
        inner.launch_configurations.update(arguments)
        inner.fixed_arguments = self.fixed_arguments | arguments.keys()
        inner.launch_file = path
        if path is not None:
            inner.included_files = (*self.included_files, path)
        return inner

    def deferred(self, function: DeferredFunction[ProcessEvent | None]) -> DeferredStep:
        """Return the step that asks `function(event, context)` for actions when its time comes."""
        return DeferredStep(after=self.after, delay_s=self.delay_s, expand=self.at_event(function))

    def at_event(self, function: DeferredFunction[EventT]) -> Callable[[EventT], Sequence[Step]]:
        """Return what turns an event into the steps of `function(event, context)`'s actions.

        It raises a LaunchError where the function does, or its actions make no sense.
        """

        def expand(event: EventT) -> Sequence[Step]:
            inner = self.scoped()
            inner.after, inner.delay_s, inner.event = (), 0.0, event
            who = "an event handler"
            with blaming(lambda: who):
                for action in check_actions(function(event, inner) or (), who):
                    action.visit(inner)
                return self.plan.finish_steps()

        return expand

    def perform_substitution(self, value: Text) -> str:
        """Return the text that a substitution stands for here."""
        return perform_text(self, value)

    def environment_variable(self, name: str) -> str | None:
        """Return a variable as a process started here would see it."""
        if name in self.environment:
            return self.environment[name]
        return self.base_environment.get(name)

    def complete_environment(self, program: str) -> dict[str, str]:
        """Return all variables that a command run while expanding gets."""
        merged = {**self.base_environment, **self.environment}
        present = {name: value for name, value in merged.items() if value is not None}
        return for_program(program, present)

    def set_environment_variable(self, name: str, value: str | None) -> None:
        """Set a variable for the processes that follow in this scope; None unsets it."""
        self.environment[name] = value

    def push_namespace(self, namespace: str) -> None:
        """Put what follows in this scope below a namespace; an absolute one replaces."""
        self.namespace = join_names(self.namespace, namespace)
