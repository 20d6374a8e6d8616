"""The list of actions that a launch file returns, and the plan that it expands to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Self, cast

from launch_py.action import Action, check_actions
from launch_py.errors import errors_attributed_to
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.plan.steps import LaunchPlan
from launch_py.ros_launch import bridged, reading_launch


class LaunchDescription:
    """Actions in the order in which they are expanded.

    Where ROS 2's own `launch` reads the file, an instance is one of its descriptions, too; see
    `launch_py.ros_launch`.
    """

    def __new__(cls, *_args: object, **_options: object) -> Self:
        """Return an instance, of the bridged class where ROS 2's `launch` reads the file."""
        launch = reading_launch() if cls is LaunchDescription else None
        if launch is None:
            return super().__new__(cls)
        return cast("Self", object.__new__(bridged(cls, launch, survey_description)))

    def __init__(  # pyright: ignore[reportInconsistentConstructor]
        self,
        initial_entities: Iterable[Action] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities = check_actions(initial_entities or (), "LaunchDescription")
        self._deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[Action]:
        """The actions."""
        return self._entities

    def add_action(self, action: Action) -> None:
        """Append one action."""
        self._entities.extend(check_actions([action], "LaunchDescription.add_action"))

    def add_entity(self, entity: Action) -> None:
        """Append one action; ROS has both names."""
        self.add_action(entity)

    def visit(self, context: LaunchContext) -> None:
        """Expand all actions in this scope."""
        if self._deprecated_reason is not None:
            name = _name(context.launch_file)
            context.warnings.append(
                f"launch file [{name}] is deprecated: {self._deprecated_reason}"
            )
        for entity in self._entities:
            entity.visit(context)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Let all actions add to the survey."""
        for entity in self._entities:
            entity.survey(survey, context)


def survey_description(
    description: LaunchDescription, environ: Mapping[str, str], path: Path | None = None
) -> LaunchSurvey:
    """Return what the description declares and contains, without expanding it.

    Raises:
        LaunchFileError: an entry has the wrong type.
    """
    survey = LaunchSurvey()
    context = LaunchContext(base_environment=environ).included(path)
    with errors_attributed_to(lambda: _name(path)):
        description.survey(survey, context)
    return survey


def expand_description(
    description: LaunchDescription,
    arguments: Mapping[str, str],
    environ: Mapping[str, str],
    path: Path | None = None,
) -> LaunchPlan:
    """Return the plan of a description.

    Raises:
        LaunchError: the description is invalid.
    """
    survey = survey_description(description, environ, path)
    context = LaunchContext(base_environment=environ).included(path)
    given = context.give(arguments)
    context.plan.surveyed_actions = survey.actions
    context.plan.surveyed_names = survey.process_names
    with errors_attributed_to(lambda: _name(path)):
        description.visit(context)
        context.warn_of_unread(given, survey.arguments)
        return context.plan.finish(context.warnings)


def _name(path: Path | None) -> str:
    return path.name if path else "the launch description"
