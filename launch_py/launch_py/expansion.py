"""From a launch file and its arguments to a plan; nothing is started here."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from launch_py.errors import UsageError, blaming
from launch_py.launch_context import LaunchContext
from launch_py.launch_description import LaunchDescription
from launch_py.near_names import describe_known
from launch_py.plan import Plan
from launch_py.survey import Survey


def survey_description(
    description: LaunchDescription, environ: Mapping[str, str], path: Path | None = None
) -> Survey:
    """Return what the description declares and contains, without expanding it.

    Raises:
        LaunchFileError: something in it is not of a kind that can be there.
    """
    survey = Survey()
    context = LaunchContext(base_environment=environ).included(path, {})
    with blaming(lambda: _name(path)):
        description.survey(survey, context)
    return survey


def expand_description(
    description: LaunchDescription,
    arguments: Mapping[str, str],
    environ: Mapping[str, str],
    path: Path | None = None,
) -> Plan:
    """Return the plan of a description.

    Args:
        description: the actions.
        arguments: values of launch arguments, as typed.
        environ: the environment in which it is expanded.
        path: the launch file it comes from.

    Raises:
        LaunchError: something in it does not make sense, or an argument is not declared.
    """
    survey = survey_description(description, environ, path)
    for name in arguments:
        if name not in survey.arguments:
            known = describe_known(name, survey.arguments, "its arguments are")
            raise UsageError(f"{_name(path)} has no launch argument {name!r}; {known}")
    context = LaunchContext(base_environment=environ).included(path, {})
    context.launch_configurations.update(arguments)
    context.plan.surveyed_actions = survey.actions
    context.plan.surveyed_names = survey.process_names
    with blaming(lambda: _name(path)):
        description.visit(context)
        return context.plan.finish()


def _name(path: Path | None) -> str:
    return path.name if path else "the launch description"
