"""The event handlers, named as in ROS 2's `launch.event_handlers`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import Any

from launch_py.action import Action, check_actions, deferred_step, steps_at_event
from launch_py.errors import LaunchFileError
from launch_py.events import ProcessEvent, ProcessIO
from launch_py.launch_context import LaunchContext
from launch_py.plan.steps import OutputHandlerStep, ShutdownHandlerStep, Step, Trigger, TriggerKind

HandlerFunction = Callable[[Any, LaunchContext], Iterable[Action] | Action | None]
Reaction = Iterable[Action] | Action | HandlerFunction
LineFunction = Callable[[ProcessIO], Iterable[Action] | Action | None]
Target = Action | str | Callable[[Action], bool] | None


class EventHandler(ABC):
    """Actions that follow an event; see `RegisterEventHandler`.

    Attributes:
        actions: the actions that are known before the event happens.
    """

    actions: list[Action]

    @abstractmethod
    def expand(self, context: LaunchContext) -> None:
        """Add the steps that wait for the event to the plan."""


class _ProcessEventHandler(EventHandler):
    """Actions that follow an event of a process.

    `target_action` is an action, the name of a process, or a function `function(action)` that
    returns whether to handle that action's events. Without it the handler handles every process,
    once each.

    A list of actions for a single process is expanded with the launch file, so mistakes in it show
    before anything starts. A function `function(event, context)`, or any actions for several
    processes, are expanded when the event happens.
    """

    kind: TriggerKind

    def __init__(self, target_action: Target, reaction: Reaction) -> None:
        name = type(self).__name__
        self.target_action = _check_target(target_action, name)
        self.function = reaction if callable(reaction) else None
        self.actions = [] if callable(reaction) else check_actions(reaction, name)

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions, which wait for the event."""
        target = self.target_action
        if not isinstance(target, Action | str):
            scope = context.scoped()
            context.plan.add_for_each(lambda name: self._step(scope.scoped(), name))
            return
        inner = context.scoped()
        inner.event = None  # The awaited event has not happened yet.
        inner.after = (*context.after, Trigger(self.kind, target))
        if self.function is not None:
            inner.plan.add(deferred_step(inner, self.function))
        with inner.plan.detached():
            for action in self.actions:
                action.visit(inner)

    def _step(self, scope: LaunchContext, name: str) -> Step:
        """Return the step that expands the actions at the event of the process `name`."""

        def react(event: Any, context: LaunchContext) -> Iterable[Action] | Action | None:
            if not _concerns(self.target_action, event):
                return None
            return self.actions if self.function is None else self.function(event, context)

        scope.after = (*scope.after, Trigger(self.kind, name))
        return deferred_step(scope, react)


class OnProcessStart(_ProcessEventHandler):
    """Actions that follow the start of a process."""

    kind = TriggerKind.STARTED

    def __init__(self, *, target_action: Target = None, on_start: Reaction) -> None:
        super().__init__(target_action, on_start)


class OnProcessExit(_ProcessEventHandler):
    """Actions that follow the exit of a process that will not be restarted.

    During the shutdown, messages are still printed and functions called, one after the other and
    each for at most 5 s; no process is started and no timer is waited for. The actions are skipped
    after a second Ctrl-C or SIGQUIT, and if the launcher itself is killed.
    """

    kind = TriggerKind.EXITED

    def __init__(self, *, target_action: Target = None, on_exit: Reaction) -> None:
        super().__init__(target_action, on_exit)


class OnProcessIO(EventHandler):
    """Actions that follow each line that a process writes, until the shutdown begins.

    The functions are called as `function(event)` and return actions, or None. The event's text is
    one line, as bytes and with its newline. `target_action` is as in `_ProcessEventHandler`.
    """

    def __init__(
        self,
        *,
        target_action: Target = None,
        on_stdout: LineFunction | None = None,
        on_stderr: LineFunction | None = None,
    ) -> None:
        self.target_action = _check_target(target_action, type(self).__name__)
        self.on_stdout = on_stdout
        self.on_stderr = on_stderr
        self.actions = []

    def expand(self, context: LaunchContext) -> None:
        """Add the step that watches the process's output to the plan."""
        target = self.target_action
        context.plan.add(
            OutputHandlerStep(
                after=context.after,
                delay_s=context.delay_s,
                processes=(target,) if isinstance(target, Action | str) else None,
                expand=steps_at_event(context, self._react),
            )
        )

    def _react(self, event: ProcessIO, _context: LaunchContext) -> Iterable[Action] | Action | None:
        if not _concerns(self.target_action, event):
            return None
        function = self.on_stdout if event.from_stdout else self.on_stderr
        return function(event) if function is not None else None


class OnShutdown(EventHandler):
    """Actions that follow the beginning of the shutdown, before the first process is stopped.

    The actions, and those that a function `function(event, context)` returns, are expanded only
    then. They cannot start a process, and functions are called as by `OnProcessExit`, each for at
    most 5 s. The event's reason is "idle" if all processes have ended by themselves. The actions
    are skipped after SIGQUIT and if the launcher itself is killed; a second Ctrl-C does not wait
    for them.
    """

    def __init__(self, *, on_shutdown: Reaction) -> None:
        known = [] if callable(on_shutdown) else check_actions(on_shutdown, type(self).__name__)
        self.actions = known
        self.function = on_shutdown if callable(on_shutdown) else lambda _event, _context: known

    def expand(self, context: LaunchContext) -> None:
        """Add the step that waits for the shutdown to the plan."""
        context.plan.add(
            ShutdownHandlerStep(
                after=context.after,
                delay_s=context.delay_s,
                expand=steps_at_event(context, self.function),
            )
        )


def _check_target(target: Target, handler: str) -> Target:
    if target is None or isinstance(target, Action | str) or callable(target):
        return target
    raise LaunchFileError(
        f"target_action= of {handler} takes an action, the name of a process or a function of an "
        f"action, not {target!r}"
    )


def _concerns(target: Target, event: ProcessEvent) -> bool:
    """Return whether the handler handles this event; only a function as target decides here."""
    if target is None or isinstance(target, Action | str):
        return True
    return isinstance(event.action, Action) and target(event.action)
