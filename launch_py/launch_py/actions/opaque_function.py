"""Lets a function of the launch file decide what follows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from launch_py.actions.action import Action, check_actions
from launch_py.errors import blaming
from launch_py.substitution import Text

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext

OpaqueResult = Iterable[Action] | Action | None


class OpaqueFunction(Action):
    """Calls `function(context, *args, **kwargs)`; the actions that it returns are expanded.

    It is called while the launch file is expanded, so before anything starts, unless an event
    handler holds it: then it is called when the event happens. Its own arguments must be declared
    outside it: they are checked before it is called.
    """

    def __init__(
        self,
        *,
        function: Callable[..., OpaqueResult],
        args: Iterable[Text] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.function = function
        self.args = tuple(args or ())
        self.kwargs = dict(kwargs or {})

    def expand(self, context: LaunchContext) -> None:
        """Call the function now, or when the event happens."""
        if context.after or context.delay_s:
            context.plan.add(context.deferred(lambda _event, scope: self._call(scope)))
            return
        for action in check_actions(self._call(context), "the OpaqueFunction's result"):
            action.visit(context)

    def _call(self, context: LaunchContext) -> Iterable[Action] | Action:
        with blaming(self.describe):
            return self.function(context, *self.args, **self.kwargs) or ()

    def describe(self) -> str:
        """Return what to call it in a message."""
        return f"OpaqueFunction {getattr(self.function, '__name__', '')}".strip()
