"""The conditions of actions, named as in ROS 2's `launch.conditions`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from launch_py.errors import SubstitutionError
from launch_py.substitution import Text, describe_text, perform_text
from launch_py.truth import parse_truth

if TYPE_CHECKING:
    from launch_py.launch_context import LaunchContext


class Condition(ABC):
    """Decides whether an action is taken."""

    @abstractmethod
    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds."""


class IfCondition(Condition):
    """Holds where the text is true, 1, yes or on."""

    def __init__(self, predicate_expression: Text) -> None:
        self.predicate_expression = predicate_expression

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds.

        Raises:
            SubstitutionError: the text is neither a word for true nor one for false.
        """
        text = perform_text(context, self.predicate_expression)
        truth = parse_truth(text)
        if truth is None:
            raise SubstitutionError(
                f"a condition on {describe_text(self.predicate_expression)} needs true or false, "
                f"not {text!r}"
            )
        return truth


class UnlessCondition(IfCondition):
    """Holds where the text is false, 0, no or off."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds; see `IfCondition.evaluate`."""
        return not super().evaluate(context)


class LaunchConfigurationEquals(Condition):
    """Holds where a launch configuration is this text, or for None, where there is none.

    ROS calls it deprecated: `IfCondition(EqualsSubstitution(LaunchConfiguration(name), text))` says
    it as well, but compares numbers and true words by value, and needs the configuration.
    """

    def __init__(self, launch_configuration_name: str, expected_value: Text | None) -> None:
        self.launch_configuration_name = launch_configuration_name
        self.expected_value = expected_value

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds.

        Raises:
            LaunchError: the expected text has no value.
        """
        expected = self.expected_value
        text = None if expected is None else perform_text(context, expected)
        return context.launch_configurations.get(self.launch_configuration_name) == text


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds where a launch configuration is not this text, or for None, where there is one."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds; see `LaunchConfigurationEquals.evaluate`."""
        return not super().evaluate(context)
