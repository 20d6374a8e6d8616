"""The event handlers, named as in ROS 2's `launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from launch_py.actions.action import Action, check_actions
from launch_py.errors import LaunchFileError
from launch_py.plan import Trigger, TriggerKind

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext

HandlerFunction = Callable[[Any, "LaunchContext"], Iterable[Action] | Action | None]
Reaction = Iterable[Action] | Action | HandlerFunction


class ProcessEventHandler:
    """Actions that follow something that a process does.

    Given as a list they are expanded with the launch file, so mistakes in them show before
    anything starts. Given as a function `function(event, context)` they are asked for when the
    event happens.
    """

    kind: TriggerKind

    def __init__(self, target_action: Action | str | None, reaction: Reaction) -> None:
        name = type(self).__name__
        if not isinstance(target_action, Action | str):
            raise LaunchFileError(
                f"{name} needs target_action=, the action or the name of one process"
            )
        self.target_action = target_action
        self.function = reaction if callable(reaction) else None
        self.actions = [] if callable(reaction) else check_actions(reaction, name)

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions; they wait for the event."""
        inner = context.scoped()
        inner.after = (*context.after, Trigger(self.kind, self.target_action))
        if self.function is not None:
            inner.plan.add(inner.deferred(self.function))
        with inner.plan.detached():
            for action in self.actions:
                action.visit(inner)


class OnProcessStart(ProcessEventHandler):
    """What follows when a process has been started."""

    kind = TriggerKind.STARTED

    def __init__(self, *, target_action: Action | str | None = None, on_start: Reaction) -> None:
        super().__init__(target_action, on_start)


class OnProcessExit(ProcessEventHandler):
    """What follows when a process has ended and will not be restarted."""

    kind = TriggerKind.EXITED

    def __init__(self, *, target_action: Action | str | None = None, on_exit: Reaction) -> None:
        super().__init__(target_action, on_exit)
