"""Actions that handle events, and the one that begins the shutdown."""

from __future__ import annotations

import signal
from abc import ABC, abstractmethod

from launch_py import events
from launch_py.action import Action, check_actions, deferred_step
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import EventHandler
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.plan.steps import ShutdownStep, SignalStep
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


class EmittedEvent(events.Event, ABC):
    """An event that does something by itself when it is emitted."""

    @abstractmethod
    def expand(self, context: LaunchContext) -> None:
        """Add the steps that do it to the plan."""


class EmitEvent(Action):
    """Emits an event: one of `launch.events`, or one of a launch file's own class."""

    def __init__(self, *, event: events.Event, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        if not isinstance(event, events.Event):
            raise LaunchFileError(f"EmitEvent takes an event, not {event!r}")
        self.event = event

    def expand(self, context: LaunchContext) -> None:
        """Add what the event does, and what its handlers do, to the plan."""
        match self.event:
            case events.ShutdownEvent():
                Shutdown(reason=self.event.reason).expand(context)
            case events.ShutdownProcess():
                self._signal(context, self.event, None)
            case events.SignalProcess(signal_number=number):
                self._signal(context, self.event, _signal_number(number))
            case events.IncludeEvent(description):
                description.visit(context.scoped())
            case EmittedEvent():
                self.event.expand(context)
            case _:
                context.plan.add(deferred_step(context, self._handled))

    def _signal(
        self, context: LaunchContext, event: events.ProcessTargetedEvent, number: int | None
    ) -> None:
        context.plan.add(
            SignalStep(
                after=context.after,
                delay_s=context.delay_s,
                concerns=event.concerns,
                signal_number=number,
            )
        )

    def _handled(self, _cause: object, context: LaunchContext) -> list[Action]:
        """Return what the handlers return that are for this event."""
        inner = context.scoped()
        inner.event = self.event
        found: list[Action] = []
        for react in context.plan.handlers_of_emitted_events:
            found += check_actions(react(self.event, inner) or (), "an event handler")
        return found


def _checked(handler: EventHandler, action: str) -> EventHandler:
    if not isinstance(handler, EventHandler):
        raise LaunchFileError(f"{action} takes an event handler, not {handler!r}")
    return handler


def _signal_number(number: int | str) -> int:
    try:
        return int(signal.Signals[number] if isinstance(number, str) else signal.Signals(number))
    except (KeyError, ValueError):
        raise LaunchFileError(f"SignalProcess: there is no signal {number!r}") from None


class RegisterEventHandler(Action):
    """Registers an event handler, whose actions run when its event happens."""

    def __init__(self, event_handler: EventHandler, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event_handler = _checked(event_handler, "RegisterEventHandler")

    def expand(self, context: LaunchContext) -> None:
        """Expand the handler's actions, which wait for the event."""
        self.event_handler.expand(context)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the handler's actions."""
        super().survey(survey, context)
        for action in self.event_handler.actions:
            action.survey(survey, context)


class UnregisterEventHandler(Action):
    """Makes an event handler handle no further events."""

    def __init__(self, event_handler: EventHandler, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        _checked(event_handler, "UnregisterEventHandler")
        if event_handler.was_expanded and not event_handler.removable:
            raise LaunchFileError(
                "an UnregisterEventHandler must exist before its handler is registered: make it "
                "where the handler is made, and return it later"
            )
        event_handler.removable = True
        self.event_handler = event_handler

    def expand(self, context: LaunchContext) -> None:
        """Unregister the handler now, or when the event happens."""
        if context.after or context.delay_s:
            context.plan.add(deferred_step(context, lambda _event, _scope: self._unregister()))
        else:
            self._unregister()

    def _unregister(self) -> None:
        self.event_handler.registered = False
