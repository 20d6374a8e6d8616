"""The event handlers, named as in ROS 2's `launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from launch_py.action import Action, check_actions, deferred_step, steps_at_event
from launch_py.errors import LaunchFileError
from launch_py.events import Event, ExecutionComplete, ProcessEvent, ProcessIO
from launch_py.launch_context import LaunchContext
from launch_py.plan.steps import OutputHandlerStep, ShutdownHandlerStep, Step, Trigger, TriggerKind

HandlerFunction = Callable[[Any, LaunchContext], Iterable[Action] | Action | None]
Reaction = Iterable[Action] | Action | HandlerFunction
LineFunction = Callable[[ProcessIO], Iterable[Action] | Action | None]
Target = Action | str | Callable[[Action], bool] | None


class EventHandler:
    """Actions that follow every event that `matcher(event)` is true for.

    The events are those of processes, the shutdown, and those that `EmitEvent` emits.

    Attributes:
        actions: the actions that are known before the event happens.
        removable: whether an `UnregisterEventHandler` for it exists. Its actions are then expanded
            only when the event happens.
        registered: false once it handles no further events.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Any], bool] = lambda _event: True,
        entities: Reaction = (),
        handle_once: bool = False,
    ) -> None:
        self.matcher = matcher
        self.function = entities if callable(entities) else None
        self.actions = [] if callable(entities) else check_actions(entities, type(self).__name__)
        self.handle_once = handle_once
        self.removable = False
        self.registered = True
        self.was_expanded = False

    def expand(self, context: LaunchContext) -> None:
        """Add the steps that wait for the events to the plan."""
        scope = context.scoped()
        for kind in (TriggerKind.STARTED, TriggerKind.EXITED):
            context.plan.add_for_each(lambda name, kind=kind: self._after(scope, kind, name))
        expand = steps_at_event(context, self.react)
        after, delay_s = context.after, context.delay_s
        for step in (
            OutputHandlerStep(after=after, delay_s=delay_s, processes=None, expand=expand),
            ShutdownHandlerStep(after=after, delay_s=delay_s, expand=expand),
        ):
            context.plan.add(step)
        context.plan.handlers_of_emitted_events.append(self.react)

    def react(self, event: Any, context: LaunchContext) -> Iterable[Action] | Action | None:
        """Return what follows an event, if this handler is for it."""
        if not self.registered or not self.matcher(event):
            return None
        self.registered = not self.handle_once
        return self.actions if self.function is None else self.function(event, context)

    def _after(self, scope: LaunchContext, kind: TriggerKind, name: str) -> Step:
        """Return the step that reacts to an event of the process `name`."""
        inner = scope.scoped()
        inner.after = (*scope.after, Trigger(kind, name))
        return deferred_step(inner, self.react)


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

    def __init__(self, target_action: Target, reaction: Reaction, handle_once: bool) -> None:
        self.target_action = _check_target(target_action, type(self).__name__)
        super().__init__(
            matcher=lambda event: _concerns(self.target_action, event),
            entities=reaction,
            handle_once=handle_once,
        )

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions, which wait for the event."""
        target = self.target_action
        self.was_expanded = True
        if not isinstance(target, Action | str):
            scope = context.scoped()
            context.plan.add_for_each(lambda name: self._after(scope, self.kind, name))
            return
        inner = context.scoped()
        inner.event = None  # The awaited event has not happened yet.
        inner.after = (*context.after, Trigger(self.kind, target))
        if self.function is not None or self.removable:
            inner.plan.add(deferred_step(inner, self.react))
            return
        with inner.plan.detached():
            for action in self.actions:
                action.visit(inner)


class OnProcessStart(_ProcessEventHandler):
    """Actions that follow the start of a process."""

    kind = TriggerKind.STARTED

    def __init__(
        self, *, target_action: Target = None, on_start: Reaction, handle_once: bool = False
    ) -> None:
        super().__init__(target_action, on_start, handle_once)


class OnProcessExit(_ProcessEventHandler):
    """Actions that follow the exit of a process that will not be restarted.

    During the shutdown, messages are still printed and functions called, one after the other and
    each for at most 5 s; no process is started and no timer is waited for. The actions are skipped
    after a second Ctrl-C or SIGQUIT, and if the launcher itself is killed.
    """

    kind = TriggerKind.EXITED

    def __init__(
        self, *, target_action: Target = None, on_exit: Reaction, handle_once: bool = False
    ) -> None:
        super().__init__(target_action, on_exit, handle_once)


class OnExecutionComplete(_ProcessEventHandler):
    """Actions that follow the end of an action: of a process, its exit.

    Any other action is done once it is expanded, so what follows it is expanded at once. The
    function gets an `ExecutionComplete`.
    """

    kind = TriggerKind.EXITED

    def __init__(
        self, *, target_action: Target = None, on_completion: Reaction, handle_once: bool = False
    ) -> None:
        def call(event: ProcessEvent, context: LaunchContext) -> Any:
            assert callable(on_completion)
            return on_completion(ExecutionComplete(action=event.action), context)

        reaction = call if callable(on_completion) else on_completion
        super().__init__(target_action, reaction, handle_once)

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions, which wait for the end of the process."""
        target = self.target_action
        if isinstance(target, Action) and not target.starts_process:
            done = ExecutionComplete(action=target)
            context.plan.add(deferred_step(context, lambda _, scope: self.react(done, scope)))
        else:
            super().expand(context)


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
        handle_once: bool = False,
    ) -> None:
        self.target_action = _check_target(target_action, type(self).__name__)
        self.on_stdout = on_stdout
        self.on_stderr = on_stderr
        super().__init__(
            matcher=lambda event: _concerns(self.target_action, event),
            entities=lambda event, _context: self._call(event),
            handle_once=handle_once,
        )

    def expand(self, context: LaunchContext) -> None:
        """Add the step that watches the process's output to the plan."""
        target = self.target_action
        context.plan.add(
            OutputHandlerStep(
                after=context.after,
                delay_s=context.delay_s,
                processes=(target,) if isinstance(target, Action | str) else None,
                expand=steps_at_event(context, self.react),
            )
        )

    def _call(self, event: ProcessIO) -> Iterable[Action] | Action | None:
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

    def __init__(self, *, on_shutdown: Reaction, handle_once: bool = False) -> None:
        super().__init__(entities=on_shutdown, handle_once=handle_once)

    def expand(self, context: LaunchContext) -> None:
        """Add the step that waits for the shutdown to the plan."""
        context.plan.add(
            ShutdownHandlerStep(
                after=context.after,
                delay_s=context.delay_s,
                expand=steps_at_event(context, self.react),
            )
        )


class OnActionEventBase(EventHandler):
    """Actions that follow the events of one class that an action is the source of."""

    def __init__(
        self,
        *,
        action_matcher: Action | Callable[[Any], bool] | None,
        on_event: Reaction,
        target_event_cls: type[Event],
        target_action_cls: type[Any],
        handle_once: bool = False,
    ) -> None:
        def matcher(event: Any) -> bool:
            source = getattr(event, "action", None)
            return (
                isinstance(event, target_event_cls)
                and isinstance(source, target_action_cls)
                and (
                    action_matcher is None
                    or source is action_matcher
                    or (not isinstance(action_matcher, Action) and bool(action_matcher(source)))
                )
            )

        super().__init__(matcher=matcher, entities=on_event, handle_once=handle_once)


def event_named(event_name: str) -> Callable[[Event], bool]:
    """Return a matcher of the events whose class has this name."""
    return lambda event: event.name == event_name


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
