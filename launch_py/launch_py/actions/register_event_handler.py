"""Registers what follows an event."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py.actions.action import Action

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.event_handlers import EventHandler
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey


class RegisterEventHandler(Action):
    """Takes the actions of an event handler when its event happens."""

    def __init__(self, event_handler: EventHandler, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event_handler = event_handler

    def expand(self, context: LaunchContext) -> None:
        """Expand the handler's actions; they wait for the event."""
        self.event_handler.expand(context)

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Survey the handler's actions."""
        super().survey(survey, context)
        for action in self.event_handler.actions:
            action.survey(survey, context)
