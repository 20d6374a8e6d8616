"""The gripper controllers and their ROS half.

All three share one state machine (`controller`): it moves a joint to the goal position and ends the
goal when the joint arrives or stalls. They differ in the interfaces that they command (`grippers`).

For the ROS half:

* Before activation, set `sink` to a `GripperSink`; it is called on the loop thread.
* On any thread: reject a goal if `check_goal` returns a reason. Pass each accepted goal to
  `submit_goal`, and each cancel request, which is always accepted, to `cancel_goal`. If
  `submit_goal` returns a `GripperResult`, the goal has ended; otherwise it ends through
  `GripperSink.finish_goal`.
* Then let the loop thread call `serve_requests`, so that a goal is preempted or cancelled
  immediately even while the simulation is paused.

Times are those of `update(time_s, period_s)`. Nothing here uses the wall clock.
"""
