"""Goals of controllers: started by the program, ended by the controller in a later tick."""

from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any, Generic, Protocol, TypeVar

from arm_control.controllers.goals import GoalEnd, GoalOutcome
from arm_sim.errors import CallError, GoalError
from arm_sim.user_traceback import ends_at_the_caller

ResultT = TypeVar("ResultT", bound=GoalEnd)


class _GoalCore(Protocol):
    """A controller's core that starts goals and reports their ends to a sink."""

    name: str
    sink: Any

    def submit_goal(self, goal: Any, /) -> Any:
        """Start an accepted goal; return its result if it has ended already."""
        ...

    def cancel_goal(self, goal_id: object) -> None:
        """Cancel a goal and stop; any thread."""
        ...

    def serve_requests(self) -> None:
        """Process the clients' requests; loop thread."""
        ...


@ends_at_the_caller
class Goal(Generic[ResultT]):
    """A goal of a controller; it advances while the simulation runs.

    Attributes:
        controller: name of the controller that executes it.
        end: how it ended; None while it is running.
        feedback: the latest feedback of a trajectory; None before the first.
    """

    def __init__(self, controller: _GoalCore, goal_id: int) -> None:
        self.controller = controller.name
        self.end: ResultT | None = None
        self.feedback: Any = None
        self._core = controller
        self._id = goal_id

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self.end is not None

    @property
    def result(self) -> ResultT:
        """The result of a goal that succeeded.

        Raises:
            GoalError: it was cancelled or aborted; with the controller's message and code.
            CallError: it has not ended.
        """
        end = self.end
        if end is None:
            raise CallError(f"the goal of '{self.controller}' has not ended; run the simulation")
        if end.outcome is not GoalOutcome.SUCCEEDED:
            message = end.message or f"the goal of '{self.controller}' was {end.outcome.value}"
            raise GoalError(message, end.outcome, getattr(end, "code", None))
        return end

    def cancel(self) -> None:
        """Cancel it, and let the controller stop the motion; has no effect if it has ended."""
        self._core.cancel_goal(self._id)
        self._core.serve_requests()


class RunningGoals:
    """Takes the results of one controller's goals; it is the controller's sink."""

    def __init__(self, controller: _GoalCore) -> None:
        """Become the sink of a controller that is not active yet."""
        self._controller = controller
        self._numbers: Iterator[int] = count(1)
        self._running: dict[int, Goal[Any]] = {}
        controller.sink = self

    def start(self, make_request: Any) -> Goal[Any]:
        """Start a goal that the controller has checked.

        `make_request` returns the controller's request for a goal's number.
        """
        number = next(self._numbers)
        goal: Goal[Any] = Goal(self._controller, number)
        self._running[number] = goal
        end = self._controller.submit_goal(make_request(number))
        if end is not None:
            self.finish_goal(number, end)
        else:
            self._controller.serve_requests()
        return goal

    @property
    def running(self) -> dict[int, Goal[Any]]:
        """The running goals, by their numbers."""
        return dict(self._running)

    def restore(self, running: Mapping[int, Goal[Any]]) -> None:
        """Continue with the goals of an earlier time; the controller has ended all others."""
        self._running = dict(running)
        for goal in running.values():
            goal.end = None

    # The sink's methods, called in a tick

    def open(self, layout: object = None) -> None:
        """Accept results from now on."""

    def publish_state(self, state: object) -> None:
        """Ignore the controller's state; a program reads the joints instead."""

    def publish_feedback(self, goal_id: int, feedback: object) -> None:
        """Store the feedback of a goal; for a goal from a file there is nobody to receive it."""
        if goal_id in self._running:
            self._running[goal_id].feedback = feedback

    def finish_goal(self, goal_id: int, result: Any) -> None:
        """End a goal; for a goal from a file there is nobody to receive the result."""
        goal = self._running.pop(goal_id, None)
        if goal is not None:
            goal.end = result
