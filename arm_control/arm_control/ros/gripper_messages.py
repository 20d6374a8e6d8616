"""From the goals of the two gripper actions to the controllers' requests, and back from results."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from control_msgs.action import GripperCommand, ParallelGripperCommand

from arm_control.gripper import GripperRequest, GripperResult


@dataclass(frozen=True, slots=True)
class GripperDialect:
    """One way to talk to a gripper.

    Attributes:
        action_type: class of the action.
        request: makes the controller's request of a goal's id and message.
        result: makes the message of a result and the joint's name.
    """

    action_type: type[Any]
    request: Callable[[bytes, Any], GripperRequest]
    result: Callable[[GripperResult, str], Any]


def gripper_command_request(goal_id: bytes, goal: GripperCommand.Goal) -> GripperRequest:
    """Return a goal that is one position and one effort."""
    return GripperRequest(goal_id, (goal.command.position,), (goal.command.max_effort,))


def gripper_command_result(result: GripperResult, joint: str) -> GripperCommand.Result:
    """Return how a goal of the older action ended."""
    message = GripperCommand.Result(stalled=result.stalled, reached_goal=result.reached_goal)
    if result.state is not None:
        message.position, message.effort = result.state.position, result.state.effort
    return message


def parallel_gripper_request(goal_id: bytes, goal: ParallelGripperCommand.Goal) -> GripperRequest:
    """Return a goal that is a joint state, in which only the position must be."""
    command = goal.command
    return GripperRequest(goal_id, command.position, command.effort, command.velocity)


def parallel_gripper_result(result: GripperResult, joint: str) -> ParallelGripperCommand.Result:
    """Return how a goal of the newer action ended."""
    message = ParallelGripperCommand.Result(
        stalled=result.stalled, reached_goal=result.reached_goal
    )
    if result.state is not None:
        message.state.name = [joint]
        message.state.position = [result.state.position]
        message.state.velocity = [result.state.velocity]
        message.state.effort = [result.state.effort]
    return message


GRIPPER_COMMAND = GripperDialect(GripperCommand, gripper_command_request, gripper_command_result)
PARALLEL_GRIPPER_COMMAND = GripperDialect(
    ParallelGripperCommand, parallel_gripper_request, parallel_gripper_result
)
