"""The conditions of actions, named as in ROS 2's `launch.conditions`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from launch_py.errors import SubstitutionError
from launch_py.substitution import LaunchScope, Text, describe_text, perform_text
from launch_py.typed_values import parse_boolean


class Condition:
    """Decides whether an action is expanded: by `predicate(context)`, or in a derived class."""

    def __init__(self, *, predicate: Callable[[Any], bool] = lambda _context: True) -> None:
        self.predicate = predicate

    def evaluate(self, context: LaunchScope) -> bool:
        """Return whether the condition holds."""
        return bool(self.predicate(context))


class IfCondition(Condition):
    """Holds if the text is true, 1, yes or on."""

    def __init__(self, predicate_expression: Text) -> None:
        self.predicate_expression = predicate_expression

    def evaluate(self, context: LaunchScope) -> bool:
        """Return whether the condition holds.

        Raises:
            SubstitutionError: the text means neither true nor false.
        """
        text = perform_text(context, self.predicate_expression)
        truth = parse_boolean(text)
        if truth is None:
            raise SubstitutionError(
                f"a condition on {describe_text(self.predicate_expression)} needs true or false, "
                f"not {text!r}"
            )
        return truth


class UnlessCondition(IfCondition):
    """Holds if the text is false, 0, no or off."""

    def evaluate(self, context: LaunchScope) -> bool:
        """Return whether the condition holds; see `IfCondition.evaluate`."""
        return not super().evaluate(context)


class LaunchConfigurationEquals(Condition):
    """Holds if a launch configuration has this value; None means that it is not set.

    ROS deprecates it in favour of
    `IfCondition(EqualsSubstitution(LaunchConfiguration(name), text))`, which compares numbers and
    booleans by value and requires the configuration to be set.
    """

    def __init__(self, launch_configuration_name: str, expected_value: Text | None) -> None:
        self.launch_configuration_name = launch_configuration_name
        self.expected_value = expected_value

    def evaluate(self, context: LaunchScope) -> bool:
        """Return whether the condition holds.

        Raises:
            LaunchError: a substitution in the expected value has no value.
        """
        expected = self.expected_value
        text = None if expected is None else perform_text(context, expected)
        return context.launch_configurations.get(self.launch_configuration_name) == text


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if a launch configuration does not have this value; None means that it is set."""

    def evaluate(self, context: LaunchScope) -> bool:
        """Return whether the condition holds; see `LaunchConfigurationEquals.evaluate`."""
        return not super().evaluate(context)
