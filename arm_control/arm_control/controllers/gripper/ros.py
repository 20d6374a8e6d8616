"""The ROS half of the gripper controllers: the action ~/gripper_cmd."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from control_msgs.action import GripperCommand, ParallelGripperCommand

from arm_control.controllers.gripper.controller import GripperController
from arm_control.controllers.gripper.goals import GripperRequest, GripperResult
from arm_control.controllers.gripper.parameters import GripperParameters
from arm_control.controllers.ros_action import ControllerAction
from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.loop.ros_executor_bridge import run_on_executor


class _GripperAction(ControllerAction[GripperController[Any], GripperResult], ABC):
    """The action of a gripper controller; without feedback, as in ros2_controllers.

    Attributes:
        action_type: class of the action.
    """

    action_type: ClassVar[type[Any]]

    def __init__(self, adapter: "_GripperAdapter", joint: str) -> None:
        self._joint = joint
        super().__init__(adapter, self.action_type, "~/gripper_cmd")

    @abstractmethod
    def request(self, goal_id: bytes, goal: Any) -> GripperRequest:
        """Return the controller's request from a goal's id and message."""

    def accepts(self, goal: Any) -> bool:
        """Return whether a goal is acceptable."""
        return not self.controller.check_goal(self.request(b"", goal))

    def submit(self, goal_id: bytes, goal: Any) -> GripperResult | None:
        """Start a goal."""
        return self.controller.submit_goal(self.request(goal_id, goal))


class GripperCommandAction(_GripperAction):
    """The older action: a goal has one position and one effort."""

    action_type = GripperCommand

    def request(self, goal_id: bytes, goal: GripperCommand.Goal) -> GripperRequest:
        """Return the controller's request."""
        return GripperRequest(goal_id, (goal.command.position,), (goal.command.max_effort,))

    def result_message(self, result: GripperResult) -> GripperCommand.Result:
        """Return the result message of a goal."""
        message = GripperCommand.Result(stalled=result.stalled, reached_goal=result.reached_goal)
        if result.state is not None:
            message.position, message.effort = result.state.position, result.state.effort
        return message


class ParallelGripperAction(_GripperAction):
    """The newer action: a goal has a joint state, of which only the position is required."""

    action_type = ParallelGripperCommand

    def request(self, goal_id: bytes, goal: ParallelGripperCommand.Goal) -> GripperRequest:
        """Return the controller's request."""
        command = goal.command
        return GripperRequest(goal_id, command.position, command.effort, command.velocity)

    def result_message(self, result: GripperResult) -> ParallelGripperCommand.Result:
        """Return the result message of a goal."""
        message = ParallelGripperCommand.Result(
            stalled=result.stalled, reached_goal=result.reached_goal
        )
        if result.state is not None:
            message.state.name = [self._joint]
            message.state.position = [result.state.position]
            message.state.velocity = [result.state.velocity]
            message.state.effort = [result.state.effort]
        return message


class _GripperAdapter(ControllerAdapter[GripperController[Any]], ABC):
    """Offers the action from the first activation on, and is the controller's sink.

    Attributes:
        action: class of the action.
    """

    action: ClassVar[type[_GripperAction]]
    _action: _GripperAction | None = None

    def on_configure(self, parameters: GripperParameters) -> None:
        """Become the controller's sink; the action follows at the first activation."""
        self._executor = self.executor
        self._joint = parameters.joint
        self.controller.sink = self

    def on_cleanup(self) -> None:
        """Withdraw the action after the results of all goals have been sent."""
        if self.controller.sink is None:
            return
        self.controller.sink = None
        if self._action is not None:
            self._action.wait_for_results()
        run_on_executor(self._executor, self._withdraw)

    # Loop thread

    def open(self) -> None:
        """Let the executor create the action, so that the loop does not wait."""
        if self._action is None:
            self._executor.create_task(self._offer)

    def finish_goal(self, goal_id: Any, result: GripperResult) -> None:
        """Send the result to the goal's client."""
        if self._action is not None:
            self._action.finish(goal_id, result)

    # Executor's thread

    def _offer(self) -> None:
        if self._action is None and self.controller.sink is self:
            self._action = self.action(self, self._joint)

    def _withdraw(self) -> None:
        if self._action is not None:
            self._action.destroy()
            self._action = None


class GripperCommandAdapter(_GripperAdapter):
    """Offers control_msgs/action/GripperCommand."""

    action = GripperCommandAction


class ParallelGripperAdapter(_GripperAdapter):
    """Offers control_msgs/action/ParallelGripperCommand."""

    action = ParallelGripperAction
