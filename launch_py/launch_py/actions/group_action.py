"""Groups actions in a scope of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from launch_py.actions.action import Action, check_actions
from launch_py.substitution import Text, perform_text

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey


class GroupAction(Action):
    """Actions under one condition; what they set stays in the group unless `scoped` is false.

    With `forwarding=False` a scoped group begins as the launch does: of what was set around it, the
    configurations, variables, namespaces, parameters and remappings, it sees only
    `launch_configurations`.
    """

    def __init__(
        self,
        actions: Iterable[Action],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[str, Text] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.actions = check_actions(actions, "GroupAction")
        self.scoped = scoped
        self.forwarding = forwarding
        self.launch_configurations = dict(launch_configurations or {})

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions in the group's scope."""
        inner = self._scope(context)
        for name, value in self.launch_configurations.items():
            # Performed with what the group itself may not see.
            inner.launch_configurations[name] = perform_text(context, value)
        for action in self.actions:
            action.visit(inner)

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Survey the actions."""
        super().survey(survey, context)
        inner = self._scope(context)
        for action in self.actions:
            action.survey(survey, inner)

    def _scope(self, context: LaunchContext) -> LaunchContext:
        if not self.scoped:
            return context
        return context.scoped() if self.forwarding else context.bare()
