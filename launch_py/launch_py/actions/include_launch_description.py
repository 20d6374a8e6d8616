"""Includes another launch file."""

from __future__ import annotations

from pathlib import Path

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchError, LaunchFileError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description import LaunchDescription
from launch_py.launch_description_entity import LaunchSurvey
from launch_py.launch_description_sources import (
    LaunchDescriptionSource,
    PythonLaunchDescriptionSource,
    read_launch_file,
)
from launch_py.substitution import Pairs, Text, keep_pairs, perform_pairs

MAX_DEPTH = 20
"""Launch files that are nested deeper than this are taken for a cycle of includes."""

Source = LaunchDescriptionSource | LaunchDescription | Text


class IncludeLaunchDescription(Action):
    """The actions of another launch file, in a scope of their own.

    The included file sees the arguments of the including file, overridden by `launch_arguments`.
    Unlike in ROS, its settings do not leak back, and there is a warning of an argument that nothing
    in it reads.
    """

    def __init__(
        self,
        launch_description_source: Source,
        *,
        launch_arguments: Pairs | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        if not isinstance(launch_description_source, LaunchDescriptionSource | LaunchDescription):
            launch_description_source = PythonLaunchDescriptionSource(launch_description_source)
        self.source = launch_description_source
        self.launch_arguments = keep_pairs(launch_arguments)
        self._read: tuple[Path, LaunchDescription] | None = None

    def expand(self, context: LaunchContext) -> None:
        """Expand the included actions."""
        arguments = dict(perform_pairs(context, self.launch_arguments, "launch_arguments="))
        path, description = self._load(context)
        inner = context.included(path)
        if len(inner.included_files) > MAX_DEPTH:
            raise LaunchFileError(f"launch files include each other in a cycle: {path}")
        survey = LaunchSurvey()
        if arguments:
            description.survey(survey, inner.surveyed())
        given = inner.fix_arguments(arguments)
        description.visit(inner)
        inner.warn_of_unread(given, survey.arguments, self.describe())

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the included actions if the file can be found without expanding anything."""
        super().survey(survey, context)
        try:
            path, description = self._load(context)
            arguments = dict(perform_pairs(context, self.launch_arguments, "launch_arguments="))
        except LaunchError:
            return
        if path is None or path not in context.included_files:
            inner = context.included(path)
            inner.fix_arguments(arguments)
            description.survey(survey, inner)

    def _load(self, context: LaunchContext) -> tuple[Path | None, LaunchDescription]:
        if isinstance(self.source, LaunchDescription):
            return context.launch_file, self.source
        path = self.source.path(context)
        # The survey and the expansion must see the same actions, so the file is read once. It is
        # kept here and not in the source: two includes of one file are two robots.
        if self._read is None or self._read[0] != path:
            self._read = (path, read_launch_file(path))
        return self._read

    def describe(self) -> str:
        """Return its name in messages."""
        if isinstance(self.source, LaunchDescription):
            return "an included launch description"
        return f"the include of {self.source.describe()}"
