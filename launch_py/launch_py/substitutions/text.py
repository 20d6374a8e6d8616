"""Substitutions for arguments, variables and texts, and those that compare and choose texts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from os import PathLike

from launch_py.errors import SubstitutionError
from launch_py.near_names import describe_known
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.typed_values import boolean_text, parse_boolean


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


def _truth(context: LaunchScope, value: Text) -> bool:
    text = perform_text(context, value)
    truth = parse_boolean(text)
    if truth is None:
        raise SubstitutionError(f"{describe_text(value)} is {text!r}, neither true nor false")
    return truth


def _equal(context: LaunchScope, left: Text, right: Text) -> bool:
    """Compare two texts as ROS does: as booleans, else as numbers, else as texts."""
    a, b = perform_text(context, left), perform_text(context, right)
    booleans = {"true": True, "1": True, "false": False, "0": False}
    if a.lower() in booleans and b.lower() in booleans:
        return booleans[a.lower()] == booleans[b.lower()]
    try:
        return math.isclose(float(a), float(b))
    except ValueError:
        return a == b


def _as_text(value: object) -> Text:
    """Return a value as a text to compare; texts and substitutions stay as they are."""
    match value:
        case None:
            return ""
        case bool():
            return boolean_text(value)
        case str() | Substitution() | PathLike():
            return value
        case list() | tuple() if any(isinstance(part, Substitution) for part in value):
            return value
    return str(value)


class _Comparison(Substitution):
    def __init__(self, left: object, right: object) -> None:
        self.left = _as_text(left)
        self.right = _as_text(right)


class EqualsSubstitution(_Comparison):
    """Whether two values are equal; numbers and booleans (1 is true) compare by value."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(_equal(context, self.left, self.right))


class NotEqualsSubstitution(_Comparison):
    """Whether two values differ; the opposite of `EqualsSubstitution`."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(not _equal(context, self.left, self.right))


class _Pair(Substitution):
    def __init__(self, left: Text, right: Text) -> None:
        self.left = left
        self.right = right


class AndSubstitution(_Pair):
    """Whether both texts are true."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(_truth(context, self.left) and _truth(context, self.right))


class OrSubstitution(_Pair):
    """Whether at least one of two texts is true."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(_truth(context, self.left) or _truth(context, self.right))


class _Several(Substitution):
    def __init__(self, *args: Text) -> None:
        self.args = args


class AllSubstitution(_Several):
    """Whether all texts are true."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(all(_truth(context, value) for value in self.args))


class AnySubstitution(_Several):
    """Whether at least one text is true."""

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(any(_truth(context, value) for value in self.args))


class BooleanSubstitution(Substitution):
    """A text that is true or false, in ROS's spelling."""

    def __init__(self, value: Text) -> None:
        self.value = value

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(_truth(context, self.value))


class NotSubstitution(Substitution):
    """The negation of a text that is true or false."""

    def __init__(self, value: Text) -> None:
        self.value = value

    def perform(self, context: LaunchScope) -> str:
        """Return 'true' or 'false'."""
        return boolean_text(not _truth(context, self.value))


class IfElseSubstitution(Substitution):
    """One of two texts, chosen by a condition."""

    def __init__(self, condition: Text, if_value: Text = "", else_value: Text = "") -> None:
        self.condition = condition
        self.if_value = if_value
        self.else_value = else_value

    def perform(self, context: LaunchScope) -> str:
        """Return the chosen text."""
        chosen = self.if_value if _truth(context, self.condition) else self.else_value
        return perform_text(context, chosen)
