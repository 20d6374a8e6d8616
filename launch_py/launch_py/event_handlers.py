"""The event handlers, named as in ROS 2's `launch.event_handlers`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from launch_py.actions.action import Action, check_actions
from launch_py.errors import LaunchFileError
from launch_py.events import ProcessEvent, ProcessIO
from launch_py.plan import FarewellStep, ListeningStep, Step, Trigger, TriggerKind

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

HandlerFunction = Callable[[Any, "LaunchContext"], Iterable[Action] | Action | None]
Reaction = Iterable[Action] | Action | HandlerFunction
LineFunction = Callable[[ProcessIO], Iterable[Action] | Action | None]
Target = Action | str | Callable[[Action], bool] | None


class EventHandler(ABC):
    """What follows an event; see `RegisterEventHandler`.

    Attributes:
        actions: those that are known before the event happens.
    """

    actions: list[Action]

    @abstractmethod
    def expand(self, context: LaunchContext) -> None:
        """Add to the plan what waits for the event."""


class ProcessEventHandler(EventHandler):
    """Actions that follow something that a process does.

    The process is that of `target_action`, or of this name; without it, or with a function
    `function(action)` that decides, it is any process, each once.

    Given as a list, for one process, the actions are expanded with the launch file, so mistakes in
    them show before anything starts. Given as a function `function(event, context)`, or for any
    process, they are asked for when the event happens.
    """

    kind: TriggerKind

    def __init__(self, target_action: Target, reaction: Reaction) -> None:
        name = type(self).__name__
        self.target_action = _check_target(target_action, name)
        self.function = reaction if callable(reaction) else None
        self.actions = [] if callable(reaction) else check_actions(reaction, name)

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions; they wait for the event."""
        target = self.target_action
        if not isinstance(target, Action | str):
            scope = context.scoped()
            context.plan.add_for_each(lambda name: self._step(scope.scoped(), name))
            return
        inner = context.scoped()
        inner.event = None  # Not the one that is waited for.
        inner.after = (*context.after, Trigger(self.kind, target))
        if self.function is not None:
            inner.plan.add(inner.deferred(self.function))
        with inner.plan.detached():
            for action in self.actions:
                action.visit(inner)

    def _step(self, scope: LaunchContext, name: str) -> Step:
        """Return what asks for the actions at the event of one of any processes."""

        def react(event: Any, context: LaunchContext) -> Iterable[Action] | Action | None:
            if not _concerns(self.target_action, event):
                return None
            return self.actions if self.function is None else self.function(event, context)

        scope.after = (*scope.after, Trigger(self.kind, name))
        return scope.deferred(react)


class OnProcessStart(ProcessEventHandler):
    """What follows when a process has been started."""

    kind = TriggerKind.STARTED

    def __init__(self, *, target_action: Target = None, on_start: Reaction) -> None:
        super().__init__(target_action, on_start)


class OnProcessExit(ProcessEventHandler):
    """What follows when a process has ended and will not be restarted.

    Also while everything stops: then messages are said and functions called, each for at most 5 s
    and one after the other, while processes are not started and timers not waited for. An end by
    a second Ctrl-C or SIGQUIT, or without the launcher, leaves them out.
    """

    kind = TriggerKind.EXITED

    def __init__(self, *, target_action: Target = None, on_exit: Reaction) -> None:
        super().__init__(target_action, on_exit)


class OnProcessIO(EventHandler):
    """What follows each line that a process writes, until everything is to stop.

    The functions are called as `function(event)` and return actions, or None. The event's text is
    one line, as bytes and with its newline. `target_action` is as in `ProcessEventHandler`.
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
        """Listen to the process."""
        target = self.target_action
        context.plan.add(
            ListeningStep(
                after=context.after,
                delay_s=context.delay_s,
                processes=(target,) if isinstance(target, Action | str) else None,
                expand=context.at_event(self._react),
            )
        )

    def _react(self, event: ProcessIO, _context: LaunchContext) -> Iterable[Action] | Action | None:
        if not _concerns(self.target_action, event):
            return None
        function = self.on_stdout if event.from_stdout else self.on_stderr
        return function(event) if function is not None else None


class OnShutdown(EventHandler):
    """What is said and called when everything is to stop, before the first process is asked to.

    The actions, also those of a function `function(event, context)`, are expanded only then. No
    process can be among them, and functions are called as by `OnProcessExit`, each for at most 5 s.
    Where everything has ended by itself the event's reason is "idle"; an end by SIGQUIT, or without
    the launcher, leaves them out, and a second Ctrl-C waits for none of them.
    """

    def __init__(self, *, on_shutdown: Reaction) -> None:
        known = [] if callable(on_shutdown) else check_actions(on_shutdown, type(self).__name__)
        self.actions = known
        self.function = on_shutdown if callable(on_shutdown) else lambda _event, _context: known

    def expand(self, context: LaunchContext) -> None:
        """Wait for the shutdown."""
        context.plan.add(
            FarewellStep(
                after=context.after,
                delay_s=context.delay_s,
                expand=context.at_event(self.function),
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
    """Return whether an event of any process is one of the target's, where a function decides."""
    if target is None or isinstance(target, Action | str):
        return True
    return event.action is not None and target(event.action)
