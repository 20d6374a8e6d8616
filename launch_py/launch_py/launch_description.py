"""The list of actions that a launch file returns."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from launch_py.actions.action import Action, check_actions

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey


class LaunchDescription:
    """Actions in the order in which they are expanded."""

    def __init__(self, initial_entities: Iterable[Action] = ()) -> None:
        self.entities: list[Action] = check_actions(initial_entities, "LaunchDescription")

    def add_action(self, action: Action) -> None:
        """Append one action."""
        self.entities.extend(check_actions([action], "LaunchDescription.add_action"))

    def add_entity(self, entity: Action) -> None:
        """Append one action; ROS has both names."""
        self.add_action(entity)

    def visit(self, context: LaunchContext) -> None:
        """Expand all actions in this scope."""
        for entity in self.entities:
            entity.visit(context)

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Let all actions add to the survey."""
        for entity in self.entities:
            entity.survey(survey, context)
