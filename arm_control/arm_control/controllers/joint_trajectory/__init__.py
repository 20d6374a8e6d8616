"""joint_trajectory_controller/JointTrajectoryController and its ROS half.

A client's `trajectory` becomes a motion profile (`profiles`): the set-point at each time from now
on. While the controller is active, the `TrajectoryTracker` (`tracking`) follows one profile after
the other, compares the motion with the goal's tolerances (`goals`), and turns set-points into
`commands`. Requests are checked (`validation`) on the client's thread and wait in an `Inbox` for
the control loop.

For the ROS half, in the order of its work:

* Parameters: `JointTrajectoryController.parameter_specs(given)` lists them for the given joints,
  and `build_parameters(values)` checks values and makes the `JointTrajectoryParameters` for
  `on_configure`. When a client sets some, build them again (`ParameterError` refuses the change)
  and call `update_parameters` on the loop thread.
* Before activation, set `sink` to a `TrajectorySink`: it publishes `~/controller_state` in every
  cycle, the action's feedback and the results, all on the loop thread. `ControllerState.values` is
  one array of all numbers in the order of `StateLayout`, for a serialised template of the message.
* Action, any thread: reject a goal if `check_goal` returns a `GoalRefusal`; with the parameter
  `reject_with_reason`, accept it anyway. Pass each accepted goal to `submit_goal`, with the goal
  handle as its `id`. If it returns a `GoalResult`, the goal has ended; otherwise it ends through
  `TrajectorySink.finish_goal`. Always accept a cancel request and pass it to `cancel_goal`.
* Topic `~/joint_trajectory`, any thread: `submit_trajectory`, which logs refusals.
* Topic `~/speed_scaling_input`, any thread, if `takes_speed_scaling`: `request_speed_scaling`.
* Service `~/query_state`, on the loop thread: `query_state`.
* After `submit_goal` and `cancel_goal`, let the loop thread call `serve_requests`, so that a goal
  is preempted or cancelled immediately even while the simulation is paused.

Behaviour that ros2_controllers leaves undefined, or does not report to the client:

* A trajectory on the topic aborts the running goal, with its own message. Upstream goes on and
  checks the goal against a trajectory that its client never sent.
* A stamp in the past: points that are already due are skipped, as upstream does; a trajectory that
  has already ended is refused. The motion steps from the current state to the first remaining
  point, unless `smooth_replacement_time` smooths it.
* A stamp in the future: the motion to the first point starts at once and arrives in time.

Times are those of `update(time_s, period_s)`. Nothing here uses the wall clock.
"""
