"""Actions that contain or return other actions."""

from __future__ import annotations

import sys
from collections.abc import Callable, Coroutine, Iterable, Mapping
from typing import Any

from launch_py.action import Action, check_actions, deferred_step
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError, errors_attributed_to
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.ros_imports import ros_imports
from launch_py.substitution import Text, keep_dict, perform_text
from launch_py.typed_values import perform_boolean, perform_seconds


class GroupAction(Action):
    """Actions under one condition; their settings stay in the group unless `scoped` is false.

    With `forwarding=False` a scoped group starts without the configurations, environment variables,
    namespace, parameters and remappings set before it. It then sees only
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
        self.launch_configurations = keep_dict(launch_configurations, "launch_configurations=")

    def expand(self, context: LaunchContext) -> None:
        """Expand the actions in the group's scope."""
        inner = self._scope(context)
        for name, value in self.launch_configurations.items():
            # Performed in the outer scope, which the group itself may not see.
            inner.launch_configurations[name] = perform_text(context, value)
        for action in self.actions:
            action.visit(inner)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the actions."""
        super().survey(survey, context)
        inner = self._scope(context)
        for action in self.actions:
            action.survey(survey, inner)

    def _scope(self, context: LaunchContext) -> LaunchContext:
        if not self.scoped:
            return context
        return context.scoped() if self.forwarding else context.bare()


class TimerAction(Action):
    """Runs its actions `period` seconds after the event they wait for, or after the start.

    To wait for another process use `ready=` and `depends_on=` instead: no delay is right on
    every machine. The shutdown cancels all timers, so `cancel_on_shutdown` can only be true.
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
            LaunchFileError: the period is not a duration, or `cancel_on_shutdown` is false.
        """
        name = "TimerAction's cancel_on_shutdown"
        if not perform_boolean(context, self.cancel_on_shutdown, name):
            raise LaunchFileError(
                f"{name} cannot be false: the shutdown cancels all timers; "
                "use OnShutdown to run actions then"
            )
        inner = context.scoped()
        period_s = perform_seconds(context, self.period, "TimerAction's period")
        inner.delay_s = context.delay_s + period_s
        for action in self.actions:
            action.visit(inner)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Survey the actions."""
        super().survey(survey, context)
        for action in self.actions:
            action.survey(survey, context)


OpaqueResult = Iterable[Action] | Action | None


class OpaqueFunction(Action):
    """Calls `function(context, *args, **kwargs)`; the actions that it returns are expanded.

    It is called while the launch file is expanded, before anything starts; inside an event handler
    it is called when the event happens. Launch arguments must be declared outside it, because they
    are checked before it is called.
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
            context.plan.add(deferred_step(context, lambda _event, scope: self._call(scope)))
            return
        for action in check_actions(self._call(context), "the OpaqueFunction's result"):
            action.visit(context)

    def _call(self, context: LaunchContext) -> Iterable[Action] | Action:
        # The function may import ROS's names, as its launch file may.
        with errors_attributed_to(self.describe), ros_imports():
            return self.function(context, *self.args, **self.kwargs) or ()

    def describe(self) -> str:
        """Return its name in messages."""
        return f"OpaqueFunction {getattr(self.function, '__name__', '')}".strip()


class OpaqueCoroutine(Action):
    """Runs `coroutine(context, *args, **kwargs)` beside the launch, in a thread with its own loop.

    It starts with the processes, or when its event happens, and ends with the launch at the latest.
    """

    def __init__(
        self,
        *,
        coroutine: Callable[..., Coroutine[Any, Any, None]],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.coroutine = coroutine
        self.args = tuple(args or ())
        self.kwargs = dict(kwargs or {})
        self.ignore_context = ignore_context

    def expand(self, context: LaunchContext) -> None:
        """Add the start of the coroutine to the plan."""
        context.plan.add(deferred_step(context, lambda _event, scope: self._start(scope)))

    def _start(self, context: LaunchContext) -> None:
        import threading

        threading.Thread(target=self._run, args=(context,), daemon=True).start()

    def _run(self, context: LaunchContext) -> None:
        import asyncio

        args = self.args if self.ignore_context else (context, *self.args)
        try:
            asyncio.run(self.coroutine(*args, **self.kwargs))
        except Exception as error:
            # The coroutine is user code and may raise anything; it must not end the launch.
            sys.stderr.write(f"{self.describe()}: {type(error).__name__}: {error}\n")

    def describe(self) -> str:
        """Return its name in messages."""
        return f"OpaqueCoroutine {getattr(self.coroutine, '__name__', '')}".strip()
