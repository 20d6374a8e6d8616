"""The base class of launch actions, and the steps that they add to the plan."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError, errors_attributed_to, errors_located_at
from launch_py.events import LaunchDescriptionEntity, ProcessEvent
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.plan.steps import DeferredStep, Step

LAUNCH_FILE = "__launch_file__"
"""The global name by which the code of a Python launch file is known; its value is the path."""


class Action(LaunchDescriptionEntity):
    """One entry of a launch description, switched on or off by its condition.

    Expanding an action starts nothing: it only adds steps to the plan or changes the context for
    the actions that follow. Processes start after the whole description has been expanded.

    Attributes:
        where: the file and line that describe it, for messages; "" for one of no launch file.
    """

    starts_process = False
    """Whether the action itself stands for a process, which ends some time."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition
        self.where = place_in_launch_file()

    def visit(self, context: LaunchContext) -> None:
        """Expand the action if its condition holds.

        Raises:
            LaunchError: the action is invalid, or an argument of it has the wrong type.
        """
        with errors_located_at(self.where), errors_attributed_to(self.describe):
            condition = self.condition
            if condition is not None and not hasattr(condition, "evaluate"):
                raise LaunchFileError(f"condition= takes an IfCondition(...), not {condition!r}")
            if condition is None or condition.evaluate(context):
                with context.plan.expanding(self):
                    self.expand(context)

    def expand(self, context: LaunchContext) -> None:
        """Add this action's steps to the plan, or change the context.

        Raises:
            LaunchError: the action is invalid.
        """
        if context.after or context.delay_s:
            context.plan.add(deferred_step(context, lambda _event, scope: self.execute(scope)))
            return
        for action in check_actions(self.execute(context) or (), self.describe()):
            action.visit(context)

    def execute(self, context: LaunchContext) -> Iterable[Action] | Action | None:
        """Return the actions that take this one's place; a launch file's own class overrides it."""
        return None

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Record this action and all actions inside it, whatever their conditions say."""
        survey.actions.add(self)


def place_in_launch_file() -> str:
    """Return the file and line of a Python launch file whose code is running, else ""."""
    frame = inspect.currentframe()
    while frame is not None:
        if LAUNCH_FILE in frame.f_globals:
            return f"{frame.f_globals[LAUNCH_FILE]}, line {frame.f_lineno}"
        frame = frame.f_back
    return ""


def check_actions(actions: Iterable[Action] | Action, owner: str) -> list[Action]:
    """Return the actions as a list, without the None entries of optional actions.

    Raises:
        LaunchFileError: an entry is neither an action nor None.
    """
    if isinstance(actions, Action):
        return [actions]
    if not isinstance(actions, Iterable):
        raise LaunchFileError(
            f"{owner} takes actions, not {actions!r} of type {type(actions).__name__}"
        )
    checked = [action for action in actions if action is not None]
    for action in checked:
        if not isinstance(action, Action):
            raise LaunchFileError(
                f"{owner} takes actions, not {action!r} of type {type(action).__name__}"
            )
    return checked


EventT = TypeVar("EventT")
DeferredFunction = Callable[[EventT, LaunchContext], Iterable[Action] | Action | None]


def deferred_step(
    context: LaunchContext, function: DeferredFunction[ProcessEvent | None]
) -> DeferredStep:
    """Return a step that, when due, calls `function(event, context)` to get its actions."""
    return DeferredStep(
        after=context.after, delay_s=context.delay_s, expand=steps_at_event(context, function)
    )


def steps_at_event(
    context: LaunchContext, function: DeferredFunction[EventT]
) -> Callable[[EventT], Sequence[Step]]:
    """Return a function that turns an event into the steps of `function(event, context)`'s actions.

    That function raises a LaunchError if `function` fails or returns invalid actions.
    """

    def expand(event: EventT) -> Sequence[Step]:
        inner = context.scoped()
        inner.after, inner.delay_s, inner.event = (), 0.0, event
        owner = "an event handler"
        with errors_attributed_to(lambda: owner):
            for action in check_actions(function(event, inner) or (), owner):
                action.visit(inner)
            return context.plan.finish_steps()

    return expand
