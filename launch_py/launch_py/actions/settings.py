"""Actions that set, keep, bring back and clear the settings of a scope."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from typing import Any

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchError, LaunchFileError, UsageError
from launch_py.launch_context import ArgumentInfo, LaunchContext, LaunchSurvey
from launch_py.near_names import describe_known
from launch_py.substitution import (
    Text,
    describe_text,
    is_costly,
    keep_dict,
    keep_list,
    perform_text,
)
from launch_py.typed_values import perform_boolean


class DeclareLaunchArgument(Action):
    """An argument `name:=value` of the launch file, with default, description and choices.

    Without a default the argument is required.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: Text | None = None,
        description: Text | None = None,
        choices: Iterable[object] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.default_value = default_value
        self.description = None if description is None else describe_text(description)
        self.choices = tuple(map(str, keep_list(choices, "choices=")))

    def expand(self, context: LaunchContext) -> None:
        """Set the default if no value is given, and check the value.

        Raises:
            UsageError: a required value is missing, or the value is not one of the choices.
        """
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                meaning = f" ({self.description})" if self.description else ""
                raise UsageError(
                    f"launch argument {self.name!r}{meaning} has no default: "
                    f"give {self.name}:=VALUE"
                )
            default = perform_text(context, self.default_value)
            context.launch_configurations[self.name] = default
        value = context.launch_configurations[self.name]
        if self.choices and value not in self.choices:
            known = describe_known(value, self.choices, "the choices are")
            if known.startswith("did you mean"):
                known += f" The choices are {', '.join(self.choices)}"
            raise UsageError(f"launch argument {self.name!r} cannot be {value!r}; {known}")

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """List the argument unless an include fixes its value."""
        super().survey(survey, context)
        default = self._shown_default(context)
        if self.name not in context.fixed_arguments:
            survey.add_argument(
                ArgumentInfo(
                    self.name, default, self.description, self.choices, context.launch_file
                )
            )
        if default is not None:
            context.launch_configurations.setdefault(self.name, default)

    def _shown_default(self, context: LaunchContext) -> str | None:
        if self.default_value is None:
            return None
        if not is_costly(self.default_value):
            with suppress(LaunchError):
                return perform_text(context, self.default_value)
        return describe_text(self.default_value)

    def describe(self) -> str:
        """Return its name in messages."""
        return f"launch argument {self.name!r}"


class SetEnvironmentVariable(Action):
    """Sets an environment variable for the processes that follow."""

    def __init__(self, name: Text, value: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value

    def expand(self, context: LaunchContext) -> None:
        """Set the variable in the context."""
        name = perform_text(context, self.name)
        context.set_environment_variable(name, perform_text(context, self.value))


class UnsetEnvironmentVariable(Action):
    """Unsets an environment variable for the processes that follow."""

    def __init__(self, name: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name

    def expand(self, context: LaunchContext) -> None:
        """Unset the variable in the context."""
        context.set_environment_variable(perform_text(context, self.name), None)


class AppendEnvironmentVariable(Action):
    """Appends or prepends a value to an environment variable that holds a list, such as PATH."""

    def __init__(
        self,
        name: Text,
        value: Text,
        *,
        prepend: bool | Text = False,
        separator: Text = os.pathsep,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value
        self.prepend = prepend
        self.separator = separator

    def expand(self, context: LaunchContext) -> None:
        """Extend the variable in the context."""
        name = perform_text(context, self.name)
        parts = [context.environment_variable(name), perform_text(context, self.value)]
        if perform_boolean(context, self.prepend, "AppendEnvironmentVariable's prepend"):
            parts.reverse()
        joined = perform_text(context, self.separator).join(part for part in parts if part)
        context.set_environment_variable(name, joined)


class SetLaunchConfiguration(Action):
    """Sets a configuration for the actions that follow; `LaunchConfiguration` reads it."""

    def __init__(self, name: Text, value: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value

    def expand(self, context: LaunchContext) -> None:
        """Set the configuration in the context."""
        name = perform_text(context, self.name)
        context.launch_configurations[name] = perform_text(context, self.value)


class PushLaunchConfigurations(Action):
    """Keeps the configurations until `PopLaunchConfigurations`."""

    def expand(self, context: LaunchContext) -> None:
        """Put a copy of the configurations on the stack."""
        context.configuration_stack.append(dict(context.launch_configurations))


class PopLaunchConfigurations(Action):
    """Brings the configurations back that `PushLaunchConfigurations` kept last."""

    def expand(self, context: LaunchContext) -> None:
        """Replace the configurations.

        Raises:
            LaunchFileError: none are kept.
        """
        if not context.configuration_stack:
            raise LaunchFileError("PopLaunchConfigurations comes without PushLaunchConfigurations")
        _replace(context.launch_configurations, context.configuration_stack.pop())


class PushEnvironment(Action):
    """Keeps the environment variables until `PopEnvironment`."""

    def expand(self, context: LaunchContext) -> None:
        """Put a copy of the variables on the stack."""
        context.environment_stack.append(dict(context.environment))


class PopEnvironment(Action):
    """Brings the environment variables back that `PushEnvironment` kept last."""

    def expand(self, context: LaunchContext) -> None:
        """Replace the variables.

        Raises:
            LaunchFileError: none are kept.
        """
        if not context.environment_stack:
            raise LaunchFileError("PopEnvironment comes without PushEnvironment")
        _replace(context.environment, context.environment_stack.pop())


class ResetEnvironment(Action):
    """Forgets all changes of environment variables: the launcher's own are left."""

    def expand(self, context: LaunchContext) -> None:
        """Clear the changes."""
        context.environment.clear()


class ReplaceEnvironmentVariables(Action):
    """Replaces all environment variables of the processes that follow."""

    def __init__(
        self, environment: Mapping[Text, Text] | None = None, *, condition: Condition | None = None
    ) -> None:
        super().__init__(condition=condition)
        self.environment = keep_dict(environment, "ReplaceEnvironmentVariables")

    def expand(self, context: LaunchContext) -> None:
        """Unset the launcher's own variables, and set the given ones."""
        given = {
            perform_text(context, name): perform_text(context, value)
            for name, value in self.environment.items()
        }
        _replace(context.environment, {**dict.fromkeys(context.base_environment), **given})


class ResetLaunchConfigurations(Action):
    """Clears the configurations, but for the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[Text, Text] | None = None,
        *,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.launch_configurations = keep_dict(launch_configurations, "ResetLaunchConfigurations")

    def expand(self, context: LaunchContext) -> None:
        """Replace the configurations."""
        # Performed first: the values may refer to what is about to be cleared.
        given = {
            perform_text(context, name): perform_text(context, value)
            for name, value in self.launch_configurations.items()
        }
        _replace(context.launch_configurations, given)


class UnsetLaunchConfiguration(Action):
    """Removes a configuration for the actions that follow."""

    def __init__(self, name: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name

    def expand(self, context: LaunchContext) -> None:
        """Remove the configuration from the context."""
        context.launch_configurations.pop(perform_text(context, self.name), None)


def _replace(target: dict[str, Any], content: Mapping[str, Any]) -> None:
    """Replace the content of a dict that others refer to."""
    target.clear()
    target.update(content)
