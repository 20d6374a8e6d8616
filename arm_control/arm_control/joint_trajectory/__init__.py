"""The joint trajectory controller without ROS.

Plans (`plans`) are functions of time made from way points (`trajectory`, `spline`, `completion`);
an `execution` takes one through time and compares it with tolerances (`tolerances`); a `follower`
runs one execution after the other while the controller is active, and turns what is wanted into
commands (`commander`, `pid`). Requests (`requests`) are checked (`validation`, `limits`) on the
thread that brings them, and wait in an `inbox` for the control loop.

For the ROS half, in the order of its work:

* Parameters. `JointTrajectoryController.parameter_specs(given)` lists them for the joints that are
  given, `build_parameters(values)` checks values and makes the `JointTrajectoryParameters` for
  `on_configure`. When a client sets some, build them anew (`ParameterError` refuses the change)
  and call `update_parameters` on the loop thread.
* Before activation, set `sink` to a `TrajectorySink`: it publishes `~/controller_state` in every
  cycle, the action's feedback, and the results; all on the loop thread. `ControllerState.values` is
  one array of all numbers in the order of `StateLayout`, for a serialised template of the message.
* Action, any thread: a goal is to be rejected where `check_goal` returns a `Refusal`; with the
  parameter `reject_with_reason` it is accepted nevertheless. Hand each accepted goal to
  `submit_goal`, its `id` being the goal handle: the `GoalResult` that it may return ends the goal
  at once, any other goal ends through `TrajectorySink.finish_goal`. A cancel request is always
  accepted and handed to `cancel_goal`.
* Topic `~/joint_trajectory`, any thread: `submit_trajectory`, which writes refusals to the log.
* Topic `~/speed_scaling_input`, any thread, where `takes_speed_scaling`: `request_speed_scaling`.
* Service `~/query_state`, on the loop thread: `query_state`.
* After `submit_goal` and `cancel_goal`, let the loop thread call `serve_requests`: then a goal is
  preempted or cancelled at once even while the simulation stands still.

Where ros2_controllers leaves something open, or leaves a client in the dark:

* A trajectory on the topic ends the goal under way (aborted, with a sentence of its own). Upstream
  goes on and judges the goal by a trajectory that its client never sent.
* A stamp in the past: points that were due by now are skipped, as upstream does; a trajectory that
  is over altogether is refused. From the present state to the first point left there is a step,
  unless `smooth_replacement_time` gives it time.
* A stamp in the future: the motion to the first point begins at once and arrives in time.

Times are those of `update(time_s, period_s)`. Nothing here knows the wall clock.
"""

from arm_control.joint_trajectory.joint_trajectory_controller import JointTrajectoryController
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.joint_trajectory.requests import (
    GoalRequest,
    JointTolerance,
    TrajectoryPoint,
    TrajectoryRequest,
)
from arm_control.joint_trajectory.results import ErrorCode, GoalResult, Outcome, Refusal
from arm_control.joint_trajectory.state import (
    ControllerState,
    Feedback,
    Progress,
    QueriedState,
    StateLayout,
    TrajectorySink,
)

__all__ = [
    "ControllerState",
    "ErrorCode",
    "Feedback",
    "GoalRequest",
    "GoalResult",
    "JointTolerance",
    "JointTrajectoryController",
    "JointTrajectoryParameters",
    "Outcome",
    "Progress",
    "QueriedState",
    "Refusal",
    "StateLayout",
    "TrajectoryPoint",
    "TrajectoryRequest",
    "TrajectorySink",
]
