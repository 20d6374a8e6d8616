"""The ROS half of the gripper controllers: the action ~/gripper_cmd."""

from abc import ABC
from typing import Any, ClassVar

from arm_control.gripper import GripperController, GripperResult
from arm_control.gripper.parameters import GripperParameters
from arm_control.ros.controller_adapter import ControllerAdapter
from arm_control.ros.executor_bridge import run_on_executor
from arm_control.ros.gripper_action import GripperAction
from arm_control.ros.gripper_messages import (
    GRIPPER_COMMAND,
    PARALLEL_GRIPPER_COMMAND,
    GripperDialect,
)


class GripperAdapter(ControllerAdapter[GripperController[Any]], ABC):
    """Offers the action from the first activation on; the sink of its controller.

    Attributes:
        dialect: the action's type and messages.
    """

    dialect: ClassVar[GripperDialect]
    _action: GripperAction | None = None

    def on_configure(self, parameters: GripperParameters) -> None:
        """Wait for the activation."""
        self._executor = self.executor
        self._joint = parameters.joint
        self.controller.sink = self

    def on_cleanup(self) -> None:
        """Withdraw the action, once the results of all goals are out."""
        if self.controller.sink is None:
            return
        self.controller.sink = None
        if self._action is not None:
            self._action.wait_for_results()
        run_on_executor(self._executor, self._withdraw)

    # Loop thread

    def open(self) -> None:
        """Have the action made where it does not hold up the loop."""
        if self._action is None:
            self._executor.create_task(self._offer)

    def finish_goal(self, goal_id: Any, result: GripperResult) -> None:
        """Bring the result to the goal's client."""
        if self._action is not None:
            self._action.finish(goal_id, result)

    # Executor's thread

    def _offer(self) -> None:
        if self._action is None and self.controller.sink is self:
            self._action = GripperAction(
                self.controller, self.node, self.loop, self._executor, self.dialect, self._joint
            )

    def _withdraw(self) -> None:
        if self._action is not None:
            self._action.destroy()
            self._action = None


class GripperCommandAdapter(GripperAdapter):
    """Offers control_msgs/action/GripperCommand."""

    dialect = GRIPPER_COMMAND


class ParallelGripperAdapter(GripperAdapter):
    """Offers control_msgs/action/ParallelGripperCommand."""

    dialect = PARALLEL_GRIPPER_COMMAND
