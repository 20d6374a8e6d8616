"""Actions that say something or end everything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py import events
from launch_py.actions.action import Action
from launch_py.errors import LaunchFileError
from launch_py.plan import MessageStep, ShutdownStep
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext


class LogInfo(Action):
    """Prints a message when the launch begins, or when the event happens that it handles."""

    def __init__(self, *, msg: Text, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.msg = msg

    def expand(self, context: LaunchContext) -> None:
        """Add the message to the plan."""
        context.plan.add(
            MessageStep(
                after=context.after, delay_s=context.delay_s, text=perform_text(context, self.msg)
            )
        )


class Shutdown(Action):
    """Stops everything, in order.

    As `on_exit=Shutdown()` of a process it makes that process a required one: the launch ends
    with its exit code.
    """

    def __init__(self, *, reason: Text = "", condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.reason = reason

    def expand(self, context: LaunchContext) -> None:
        """Add the shutdown to the plan."""
        context.plan.add(
            ShutdownStep(
                after=context.after,
                delay_s=context.delay_s,
                reason=perform_text(context, self.reason),
            )
        )


class EmitEvent(Action):
    """Emits an event; `events.Shutdown` is the one there is."""

    def __init__(self, *, event: events.Shutdown, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        if not isinstance(event, events.Shutdown):
            raise LaunchFileError(f"EmitEvent takes events.Shutdown(...), not {event!r}")
        self.event = event

    def expand(self, context: LaunchContext) -> None:
        """Add the shutdown to the plan."""
        Shutdown(reason=self.event.reason).expand(context)
