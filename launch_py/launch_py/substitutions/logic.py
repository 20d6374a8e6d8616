"""Substitutions that compare and choose; their results read 'true' and 'false'."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch_py.errors import SubstitutionError
from launch_py.substitution import Substitution, Text, describe_text, perform_text
from launch_py.truth import parse_truth, truth_text

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext


def _truth(context: LaunchContext, value: Text) -> bool:
    text = perform_text(context, value)
    truth = parse_truth(text)
    if truth is None:
        raise SubstitutionError(f"{describe_text(value)} is {text!r}, neither true nor false")
    return truth


def _equal(context: LaunchContext, left: Text, right: Text) -> bool:
    """Compare as ROS does: true words equal true words, numbers equal numbers, else texts."""
    a, b = perform_text(context, left), perform_text(context, right)
    if a.lower() in ("true", "false") and b.lower() in ("true", "false"):
        return a.lower() == b.lower()
    try:
        return float(a) == float(b)
    except ValueError:
        return a == b


class _Pair(Substitution):
    def __init__(self, left: Text, right: Text) -> None:
        self.left = left
        self.right = right


class EqualsSubstitution(_Pair):
    """Whether two texts are the same; numbers and true/false compare by value."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(_equal(context, self.left, self.right))


class NotEqualsSubstitution(_Pair):
    """Whether two texts differ."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(not _equal(context, self.left, self.right))


class AndSubstitution(_Pair):
    """Whether both are true."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(_truth(context, self.left) and _truth(context, self.right))


class OrSubstitution(_Pair):
    """Whether one of both is true."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(_truth(context, self.left) or _truth(context, self.right))


class _Several(Substitution):
    def __init__(self, *args: Text) -> None:
        self.args = args


class AllSubstitution(_Several):
    """Whether all of several are true."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(all(_truth(context, value) for value in self.args))


class AnySubstitution(_Several):
    """Whether one of several is true."""

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(any(_truth(context, value) for value in self.args))


class NotSubstitution(Substitution):
    """The opposite."""

    def __init__(self, value: Text) -> None:
        self.value = value

    def perform(self, context: LaunchContext) -> str:
        """Return 'true' or 'false'."""
        return truth_text(not _truth(context, self.value))


class IfElseSubstitution(Substitution):
    """One of two texts, chosen by a condition."""

    def __init__(self, condition: Text, if_value: Text = "", else_value: Text = "") -> None:
        self.condition = condition
        self.if_value = if_value
        self.else_value = else_value

    def perform(self, context: LaunchContext) -> str:
        """Return the chosen text."""
        chosen = self.if_value if _truth(context, self.condition) else self.else_value
        return perform_text(context, chosen)
