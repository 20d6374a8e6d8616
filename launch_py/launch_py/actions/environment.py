"""Sets environment variables and configurations for what follows in the scope."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from launch_py.actions.action import Action
from launch_py.substitution import Text, perform_text
from launch_py.truth import perform_truth

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext


class SetEnvironmentVariable(Action):
    """Sets a variable for the processes that follow."""

    def __init__(self, name: Text, value: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value

    def expand(self, context: LaunchContext) -> None:
        """Set it in the context."""
        name = perform_text(context, self.name)
        context.set_environment_variable(name, perform_text(context, self.value))


class UnsetEnvironmentVariable(Action):
    """Removes a variable for the processes that follow."""

    def __init__(self, name: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name

    def expand(self, context: LaunchContext) -> None:
        """Unset it in the context."""
        context.set_environment_variable(perform_text(context, self.name), None)


class AppendEnvironmentVariable(Action):
    """Adds a part to a list-like variable such as PATH, at its end or at its beginning."""

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
        """Extend it in the context."""
        name = perform_text(context, self.name)
        parts = [context.environment_variable(name), perform_text(context, self.value)]
        if perform_truth(context, self.prepend, "AppendEnvironmentVariable's prepend"):
            parts.reverse()
        joined = perform_text(context, self.separator).join(part for part in parts if part)
        context.set_environment_variable(name, joined)


class SetLaunchConfiguration(Action):
    """Sets a configuration for what follows; `LaunchConfiguration` reads it."""

    def __init__(self, name: Text, value: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value

    def expand(self, context: LaunchContext) -> None:
        """Set it in the context."""
        name = perform_text(context, self.name)
        context.launch_configurations[name] = perform_text(context, self.value)
