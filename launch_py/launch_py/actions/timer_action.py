"""Delays actions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from launch_py.actions.action import Action, check_actions
from launch_py.errors import LaunchFileError
from launch_py.seconds import perform_seconds
from launch_py.substitution import Text
from launch_py.truth import perform_truth

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey


class TimerAction(Action):
    """Takes its actions `period` seconds after the event they wait for, or after the start.

    To wait for another process use `ready=` and `depends_on=` instead: no delay is right on
    every machine. Once everything stops no timer is waited for, so `cancel_on_shutdown` can only be
    true.
    """

    def __init__(
        self,
        *,
        period: float | Text,
        actions: Iterable[Action],
        cancel_on_shutdown: bool | Text = True,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.period = period
        self.cancel_on_shutdown = cancel_on_shutdown
        self.actions = check_actions(actions, "TimerAction")

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions with the delay added.

        Raises:
            LaunchFileError: the period is no time, or the timer is to outlive the shutdown.
        """
        name = "TimerAction's cancel_on_shutdown"
        if not perform_truth(context, self.cancel_on_shutdown, name):
            raise LaunchFileError(
                f"{name} cannot be false: no timer is waited for once everything stops; "
                "OnShutdown takes actions then"
            )
        inner = context.scoped()
        period_s = perform_seconds(context, self.period, "TimerAction's period")
        inner.delay_s = context.delay_s + period_s
        for action in self.actions:
            action.visit(inner)

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Survey the actions."""
        super().survey(survey, context)
        for action in self.actions:
            action.survey(survey, context)
