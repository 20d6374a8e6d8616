"""Substitutions for arguments, environment variables and texts."""

from __future__ import annotations

from collections.abc import Iterable

from launch_py.errors import SubstitutionError
from launch_py.near_names import describe_known
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text


class TextSubstitution(Substitution):
    """A plain text."""

    def __init__(self, *, text: str) -> None:
        self.text = text

    def perform(self, context: LaunchScope) -> str:
        """Return the text."""
        return self.text

    def describe(self) -> str:
        """Return the text."""
        return self.text


class LaunchConfiguration(Substitution):
    """The value of a launch argument, or of `SetLaunchConfiguration`."""

    def __init__(self, variable_name: Text, *, default: Text | None = None) -> None:
        self.variable_name = variable_name
        self.default = default

    def perform(self, context: LaunchScope) -> str:
        """Return the value in this scope, else the default."""
        name = perform_text(context, self.variable_name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]
        if self.default is not None:
            return perform_text(context, self.default)
        known = describe_known(name, context.launch_configurations, "declared so far:")
        raise SubstitutionError(f"no launch argument {name!r} is declared before its use; {known}")

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"LaunchConfiguration({describe_text(self.variable_name)!r})"


class LocalSubstitution(Substitution):
    """An attribute of the event being handled, as in `LocalSubstitution("event.reason")`.

    It has a value in actions that are expanded when the event happens: those of `OnShutdown`, those
    that a function returns, and those of a handler for all processes. The lists of other handlers
    are expanded before.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.description = description

    def perform(self, context: LaunchScope) -> str:
        """Return the attribute of the event as a text."""
        name, _, path = self.expression.partition(".")
        if name != "event" or not path:
            raise SubstitutionError(f"{self.describe()} has no value: only event.NAME has one")
        value = context.event
        if value is None:
            raise SubstitutionError(
                f"{self.describe()} has no value before the event; give the handler a function of "
                "event and context"
            )
        for part in path.split("."):
            if not hasattr(value, part):
                kind = type(value).__name__
                raise SubstitutionError(f"{self.describe()} has no value: no {part!r} in {kind}")
            value = getattr(value, part)
        return str(value)

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return self.description or f"LocalSubstitution({self.expression!r})"


class EnvironmentVariable(Substitution):
    """The value of an environment variable, as the launch file has set it so far."""

    def __init__(self, name: Text, *, default_value: Text | None = None) -> None:
        self.name = name
        self.default_value = default_value

    def perform(self, context: LaunchScope) -> str:
        """Return the value, else the default."""
        name = perform_text(context, self.name)
        value = context.environment_variable(name)
        if value is not None:
            return value
        if self.default_value is not None:
            return perform_text(context, self.default_value)
        raise SubstitutionError(f"environment variable {name} is not set and has no default")

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return f"EnvironmentVariable({describe_text(self.name)!r})"


class StringJoinSubstitution(Substitution):
    """Texts joined with a delimiter between them."""

    def __init__(self, substitutions: Iterable[Text], delimiter: Text = "") -> None:
        self.parts = tuple(substitutions)
        self.delimiter = delimiter

    def perform(self, context: LaunchScope) -> str:
        """Return the joined text."""
        parts = (perform_text(context, part) for part in self.parts)
        return perform_text(context, self.delimiter).join(parts)

    def describe(self) -> str:
        """Return the substitution as a launch file writes it."""
        return describe_text(self.delimiter).join(map(describe_text, self.parts))
