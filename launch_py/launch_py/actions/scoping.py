"""Actions that keep, bring back and clear the settings of a scope."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from launch_py.action import Action
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError
from launch_py.launch_context import LaunchContext
from launch_py.substitution import Text, perform_text


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
        self.environment = dict(environment or {})

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
        self.launch_configurations = dict(launch_configurations or {})

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
