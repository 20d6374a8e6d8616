"""Substitutions that compare and choose; comparisons return 'true' or 'false'."""

from __future__ import annotations

import math
from os import PathLike

from launch_py.errors import SubstitutionError
from launch_py.substitution import LaunchScope, Substitution, Text, describe_text, perform_text
from launch_py.typed_values import boolean_text, parse_boolean


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
