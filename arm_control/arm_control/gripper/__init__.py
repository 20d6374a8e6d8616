"""The gripper controllers without ROS.

All three are one machine (`gripper_controller`): it moves a joint to the position of a goal, and
ends the goal when the joint is there or moves no more (`goal_watch`). They differ in what they
write (`position_gripper_controller`, `effort_gripper_controller`, `parallel_gripper_controller`).

For the ROS half:

* Before activation, set `sink` to a `GripperSink`; it is called on the loop thread.
* Any thread: a goal is to be rejected where `check_goal` returns a sentence; hand each accepted one
  to `submit_goal`, and a cancel request, always accepted, to `cancel_goal`. The `GripperResult`
  that `submit_goal` may return ends the goal at once, any other goal ends through
  `GripperSink.finish_goal`.
* Afterwards let the loop thread call `serve_requests`: then a goal is preempted or cancelled at
  once even while the simulation stands still.

Times are those of `update(time_s, period_s)`. Nothing here knows the wall clock.
"""

from arm_control.gripper.effort_gripper_controller import EffortGripperController
from arm_control.gripper.gripper_controller import GripperController
from arm_control.gripper.gripper_sink import GripperSink
from arm_control.gripper.parallel_gripper_controller import ParallelGripperController
from arm_control.gripper.position_gripper_controller import PositionGripperController
from arm_control.gripper.requests import GripperRequest
from arm_control.gripper.results import GripperResult, GripperState

__all__ = [
    "EffortGripperController",
    "GripperController",
    "GripperRequest",
    "GripperResult",
    "GripperSink",
    "GripperState",
    "ParallelGripperController",
    "PositionGripperController",
]
