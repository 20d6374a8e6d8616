"""Actions that handle events, and the one that begins the shutdown."""

from __future__ import annotations

from launch_py import events
from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import EventHandler
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_entity import LaunchSurvey
from launch_py.plan.steps import ShutdownStep
from launch_py.substitution import Text, perform_text


class Shutdown(Action):
    """Stops all processes in order.

    `on_exit=Shutdown()` makes a process a required one: the launch ends with its exit code.
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
    """Emits an event; `events.Shutdown` is the only kind supported."""

    def __init__(self, *, event: events.Shutdown, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        if not isinstance(event, events.Shutdown):
            raise LaunchFileError(f"EmitEvent takes events.Shutdown(...), not {event!r}")
        self.event = event

    def expand(self, context: LaunchContext) -> None:
        """Add the shutdown to the plan."""
        Shutdown(reason=self.event.reason).expand(context)


class RegisterEventHandler(Action):
    """Registers an event handler, whose actions run when its event happens."""

    def __init__(self, event_handler: EventHandler, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event_handler = event_handler

    def expand(self, context: LaunchContext) -> None:
        """Expand the handler's actions, which wait for the event."""
        self.event_handler.expand(context)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the handler's actions."""
        super().survey(survey, context)
        for action in self.event_handler.actions:
            action.survey(survey, context)
