"""The base of everything that a launch description consists of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import TYPE_CHECKING

from launch_py.errors import LaunchFileError, blaming

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey


class Action(ABC):
    """One entry of a launch description, switched on or off by its condition.

    Expanding an action only describes: it adds steps to the plan or changes the context for what
    follows. Nothing is started before the whole description is expanded.
    """

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition

    def visit(self, context: LaunchContext) -> None:
        """Expand it where its condition holds.

        Raises:
            LaunchError: something in it does not make sense, or is not of a kind that it takes.
        """
        with blaming(self.describe):
            if self.condition is None or self.condition.evaluate(context):
                with context.plan.expanding(self):
                    self.expand(context)

    @abstractmethod
    def expand(self, context: LaunchContext) -> None:
        """Add what this action means to the plan, or to the context.

        Raises:
            LaunchError: something in it does not make sense.
        """

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Note this action and all below it, whatever the conditions say."""
        survey.actions.add(self)

    def describe(self) -> str:
        """Return what to call it in a message."""
        return f"a {type(self).__name__}"


def check_actions(actions: Iterable[Action] | Action, owner: str) -> list[Action]:
    """Return the actions as a list; None entries, as an optional action leaves, are dropped.

    Raises:
        LaunchFileError: something else is among them.
    """
    if isinstance(actions, Action):
        return [actions]
    checked = [action for action in actions if action is not None]
    for action in checked:
        if not isinstance(action, Action):
            raise LaunchFileError(
                f"{owner} takes actions, not {action!r} of type {type(action).__name__}"
            )
    return checked
