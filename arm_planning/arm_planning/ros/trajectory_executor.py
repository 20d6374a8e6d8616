"""Runs trajectories on the controllers' actions, and stops them."""

import math
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory, GripperCommand, ParallelGripperCommand
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node

from arm_node.names import listing
from arm_planning.errors import ControlError, MoveItErrorCode, PlanningError
from arm_planning.execution import (
    ControllerKind,
    ExecutionSettings,
    TrajectoryController,
    choose_controllers,
    part_for,
)
from arm_planning.ros.convert import trajectory_message
from arm_planning.ros.joint_state_monitor import JointStateMonitor
from arm_planning.ros.noted_action_client import NotedActionClient
from arm_planning.trajectory import TimedTrajectory

ACTIONS: dict[ControllerKind, type[Any]] = {
    ControllerKind.FOLLOW_JOINT_TRAJECTORY: FollowJointTrajectory,
    ControllerKind.GRIPPER_COMMAND: GripperCommand,
    ControllerKind.PARALLEL_GRIPPER_COMMAND: ParallelGripperCommand,
}
OFF_THE_WAY = (
    FollowJointTrajectory.Result.PATH_TOLERANCE_VIOLATED,
    FollowJointTrajectory.Result.GOAL_TOLERANCE_VIOLATED,
)
UNSEEN = (
    "; if it touches a thing, or the floor, that the planning scene lacks, add it: "
    "scene_from_world:=true adds what is in the simulation"
)
POLL_S = 0.005
SERVER_TIMEOUT_S = 2.0
STATE_TIMEOUT_S = 1.0
STOP_TIMEOUT_S = 2.0
END_TIMEOUT_S = 3.0
CANCEL_AGAIN_S = 0.25
REST_TIMEOUT_S = 1.0
ANSWER_TIMEOUT_S = 2.0
"""How long the controllers of a robot that stands still may take to say that they are done."""
RESTS = 1e-3
"""Speed below which the robot counts as still, rad/s or m/s."""

Watch = Callable[[float], str]
"""Takes the time since the start in s; returns why the rest of the way is blocked, or ""."""


@dataclass(frozen=True, slots=True)
class ExecutionOutcome:
    """How an execution ended: MoveIt's code, and the reason unless it succeeded."""

    code: MoveItErrorCode
    message: str = ""


STOPPED = ExecutionOutcome(MoveItErrorCode.PREEMPTED, "the motion was stopped")


class ExecutionManager:
    """Runs one trajectory at a time; a thread that calls `execute` waits for its end."""

    def __init__(
        self,
        node: Node,
        states: JointStateMonitor,
        controllers: Callable[[], Sequence[TrajectoryController]],
        settings: ExecutionSettings,
    ) -> None:
        """Prepare to run trajectories; other threads must spin the node.

        `controllers` returns the controllers that there are now.
        """
        self._node = node
        self._states = states
        self.controllers = controllers
        self._settings = settings
        self._group = ReentrantCallbackGroup()
        self._clients: dict[tuple[str, ControllerKind], NotedActionClient] = {}
        self._busy = threading.Lock()
        self._stop = threading.Event()
        self._is_over = False

    def stop(self) -> None:
        """Stop the robot; `execute` returns PREEMPTED. Any thread."""
        self._stop.set()

    def end(self) -> None:
        """Stop the robot for good, while the node is still spun, and wait until it is done."""
        self._is_over = True
        self._stop.set()
        if self._busy.acquire(timeout=END_TIMEOUT_S):
            self._busy.release()

    def execute(
        self,
        trajectory: TimedTrajectory,
        names: Sequence[str] = (),
        watch: Watch | None = None,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> ExecutionOutcome:
        """Run a trajectory, whose first point is where the robot is, to its end.

        If there are names, only these controllers are used. `watch` is called while the robot
        moves; `interrupted` tells when the motion is to end early, as `stop` does.

        Returns:
            SUCCESS, or why the robot did not get to the end: CONTROL_FAILED, TIMED_OUT, PREEMPTED,
            or MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE.
        """
        if not self._busy.acquire(blocking=False):
            busy = "Cannot push a new trajectory while another is being executed"
            return ExecutionOutcome(MoveItErrorCode.CONTROL_FAILED, busy)
        try:
            self._stop.clear()
            if self._is_over:
                return STOPPED
            if not len(trajectory.times_s):
                return ExecutionOutcome(MoveItErrorCode.SUCCESS)
            chosen = choose_controllers(list(self.controllers()), trajectory.joints, names)
            self._check_start(trajectory, chosen, interrupted)
            run = _Run([self._goal(trajectory, each) for each in chosen])
            if interrupted():
                return STOPPED
            return self._follow(run, watch, interrupted)
        except PlanningError as error:
            return ExecutionOutcome(error.code, str(error))
        finally:
            self._busy.release()

    def _check_start(
        self,
        trajectory: TimedTrajectory,
        chosen: Sequence[TrajectoryController],
        interrupted: Callable[[], bool],
    ) -> None:
        """Refuse a trajectory that begins where the robot is not.

        A gripper's command has a goal alone, so it may begin anywhere: it may hold an object.
        """
        tolerance = self._settings.start_tolerance
        if tolerance <= 0.0:
            return
        if problem := self._states.wait_for_fresh(STATE_TIMEOUT_S, interrupted):
            raise ControlError(f"Failed to validate trajectory: {problem}")
        present = self._states.positions()
        follow = ControllerKind.FOLLOW_JOINT_TRAJECTORY
        checked = {joint for each in chosen if each.kind is follow for joint in each.joints}
        for joint, wanted in zip(trajectory.joints, trajectory.positions[0].tolist(), strict=True):
            distance = abs(wanted - present.get(joint, wanted))
            if joint in checked and distance > tolerance:
                raise ControlError(
                    "Invalid Trajectory: start point deviates from current robot state more than "
                    f"{tolerance:g} at joint '{joint}': it is at {present[joint]:.4f}, the "
                    f"trajectory starts at {wanted:.4f}; plan again from where the robot is"
                )

    def _goal(self, trajectory: TimedTrajectory, controller: TrajectoryController) -> "_Goal":
        key = (controller.action_name, controller.kind)
        if key not in self._clients:
            self._clients[key] = NotedActionClient(
                self._node,
                ACTIONS[controller.kind],
                controller.action_name,
                callback_group=self._group,
            )
        client = self._clients[key]
        if not client.wait_for_server(SERVER_TIMEOUT_S):
            raise ControlError(
                f"Action client not connected to action server: {controller.action_name}; is the "
                "controller active? `arm control list_controllers` tells"
            )
        part = part_for(trajectory, controller)
        longest_s = self._settings.longest_s(trajectory.duration_s, controller)
        return _Goal(controller, client, part, longest_s)

    def _follow(
        self, run: "_Run", watch: Watch | None, interrupted: Callable[[], bool]
    ) -> ExecutionOutcome:
        moving = _Stopwatch(self._states)
        accepted_by_s = time.monotonic() + SERVER_TIMEOUT_S
        run.send()
        try:
            while not (outcome := run.outcome() or self._interruption(run, moving, watch)):
                if interrupted():
                    self.stop()
                if not run.is_accepted and time.monotonic() < accepted_by_s:
                    # It does not move yet; on a busy machine the answers take a while.
                    moving = _Stopwatch(self._states)
        finally:
            # Whatever ended it, an error of the watch included: what still runs is stopped.
            running = run.cancel()
        if running:
            return replace(
                outcome,
                message=f"{outcome.message}; {running} did not say within {STOP_TIMEOUT_S:g} s "
                "that it stopped: the robot may still move",
            )
        if outcome.code is MoveItErrorCode.SUCCESS:
            self._wait_until_still()
        return outcome

    def _interruption(
        self, run: "_Run", moving: "_Stopwatch", watch: Watch | None
    ) -> ExecutionOutcome | None:
        """Wait a moment; return why the run must end before the controllers are done."""
        if self._stop.wait(POLL_S):
            return STOPPED
        elapsed_s = moving.read_s()
        if self._settings.monitors_duration and moving.is_over(run.longest_s):
            return ExecutionOutcome(
                MoveItErrorCode.TIMED_OUT,
                "Controller is taking too long to execute trajectory (the expected upper bound "
                f"for the trajectory execution was {run.longest_s:.2f} seconds). Stopping "
                "trajectory.",
            )
        if watch is not None and (blocked := watch(elapsed_s)):
            return ExecutionOutcome(
                MoveItErrorCode.MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE,
                f"the way ahead is no longer free: {blocked}",
            )
        return None

    def _wait_until_still(self) -> None:
        deadline_s = time.monotonic() + REST_TIMEOUT_S
        while self._states.largest_speed() > RESTS and time.monotonic() < deadline_s:
            time.sleep(POLL_S)


class _Stopwatch:
    """The robot's time since it was made."""

    def __init__(self, states: JointStateMonitor) -> None:
        self._states = states
        self._start_s = states.stamp_s
        self._read_s = 0.0
        self._over_since_s = math.inf

    def is_over(self, limit_s: float) -> bool:
        """Return whether the last time read is beyond a limit.

        A robot that stands still may have arrived: on a busy machine the answer takes a while.
        """
        now_s = time.monotonic()
        self._over_since_s = min(self._over_since_s, now_s) if self._read_s > limit_s else math.inf
        waits = now_s - self._over_since_s < ANSWER_TIMEOUT_S
        return self._read_s > limit_s and not (waits and self._states.largest_speed() < RESTS)

    def read_s(self) -> float:
        """Return the time; it goes on where somebody sets the clock back to before the start.

        A snapshot that has this motion is never from before, and takes the motion back, too.
        """
        stamp_s = self._states.stamp_s
        if stamp_s < self._start_s:
            self._start_s = stamp_s - self._read_s
        self._read_s = stamp_s - self._start_s
        return self._read_s


class _Run:
    """The goals of one trajectory, one for each controller."""

    def __init__(self, goals: "list[_Goal]") -> None:
        self._goals = goals
        self.longest_s = max(goal.longest_s for goal in goals)

    def send(self) -> None:
        for goal in self._goals:
            goal.send()

    @property
    def is_accepted(self) -> bool:
        """Whether all controllers have taken their goals."""
        return all(goal.is_accepted for goal in self._goals)

    def outcome(self) -> ExecutionOutcome | None:
        """Return how it ended: the first failure, or success once all have ended."""
        outcomes = [goal.outcome() for goal in self._goals]
        for outcome in outcomes:
            if outcome is not None and outcome.code is not MoveItErrorCode.SUCCESS:
                return outcome
        return None if None in outcomes else ExecutionOutcome(MoveItErrorCode.SUCCESS)

    def cancel(self) -> str:
        """Cancel what still runs, and wait until the controllers have said that it ended.

        A wish to cancel that is lost is sent again: the robot must stop.

        Returns:
            "", or the names of the controllers that have not said so.
        """
        deadline_s = time.monotonic() + STOP_TIMEOUT_S
        again_s = 0.0
        while running := [goal for goal in self._goals if goal.runs]:
            now_s = time.monotonic()
            if now_s >= deadline_s:
                return listing(goal.controller.name for goal in running)
            if now_s >= again_s:
                again_s = now_s + CANCEL_AGAIN_S
                for goal in running:
                    goal.cancel()
            time.sleep(POLL_S)
        return ""


class _Goal:
    """One controller's goal; its futures complete on the threads that spin the node."""

    def __init__(
        self,
        controller: TrajectoryController,
        client: NotedActionClient,
        part: TimedTrajectory,
        longest_s: float,
    ) -> None:
        self.longest_s = longest_s
        self.controller = controller
        self._client = client
        self._message = _goal_message(part, controller)
        self._joints = part.joints
        self._handle: Any = None
        self._result: Any = None
        self._refused = False
        self._wants_cancel = False
        self._lost_since_s = 0.0

    def send(self) -> None:
        self._client.send_goal_async(self._message).add_done_callback(self._answered)

    @property
    def runs(self) -> bool:
        return self._result is None and not self._refused and self._client.server_is_ready()

    @property
    def is_accepted(self) -> bool:
        return self._handle is not None

    def cancel(self) -> None:
        self._wants_cancel = True
        if self._handle is not None and self._result is None:
            self._handle.cancel_goal_async()

    def outcome(self) -> ExecutionOutcome | None:
        name = self.controller.name
        if self._refused:
            missing = [each for each in self.controller.joints if each not in self._joints]
            why = (
                f"it has nothing for {listing(missing)}, which only a controller with "
                "allow_partial_joints_goal takes"
                if missing
                else "is it active? `arm control list_controllers` and its log tell"
            )
            return ExecutionOutcome(
                MoveItErrorCode.CONTROL_FAILED,
                f"controller '{name}' refused the trajectory; {why}",
            )
        if self._result is not None:
            return self._ended(self._result)
        if self._client.server_is_ready():
            self._lost_since_s = 0.0
        elif not self._lost_since_s:
            self._lost_since_s = time.monotonic()
        elif time.monotonic() - self._lost_since_s > SERVER_TIMEOUT_S:
            return ExecutionOutcome(
                MoveItErrorCode.CONTROL_FAILED,
                f"controller '{name}' ended while it moved the robot",
            )
        return None

    def _answered(self, future: Any) -> None:
        handle = future.result()
        if handle is None or not handle.accepted:
            self._refused = True
            return
        self._handle = handle
        handle.get_result_async().add_done_callback(self._has_result)
        if self._wants_cancel:
            handle.cancel_goal_async()

    def _has_result(self, future: Any) -> None:
        self._result = future.result()

    def _ended(self, result: Any) -> ExecutionOutcome:
        succeeded = result.status == GoalStatus.STATUS_SUCCEEDED
        stalled = getattr(result.result, "stalled", False)
        if succeeded or (stalled and self.controller.stall_is_success):
            return ExecutionOutcome(MoveItErrorCode.SUCCESS)
        name = self.controller.name
        if result.status == GoalStatus.STATUS_CANCELED:
            return ExecutionOutcome(
                MoveItErrorCode.PREEMPTED, f"controller '{name}' was told to stop"
            )
        reason = getattr(result.result, "error_string", "") or (
            "a thing stops the gripper" if stalled else "see its log"
        )
        advice = UNSEEN if getattr(result.result, "error_code", 0) in OFF_THE_WAY else ""
        return ExecutionOutcome(
            MoveItErrorCode.CONTROL_FAILED, f"controller '{name}' gave up: {reason}{advice}"
        )


def _goal_message(part: TimedTrajectory, controller: TrajectoryController) -> Any:
    if controller.kind is ControllerKind.FOLLOW_JOINT_TRAJECTORY:
        trajectory = trajectory_message("", part).joint_trajectory
        for point in trajectory.points:
            # Missing derivatives are NaN here and empty in a message.
            point.velocities = point.velocities if np.isfinite(point.velocities).all() else []
            known = np.isfinite(point.accelerations).all()
            point.accelerations = point.accelerations if known else []
        return FollowJointTrajectory.Goal(trajectory=trajectory)
    position = float(part.positions[-1, part.joints.index(controller.joints[0])])
    if controller.kind is ControllerKind.GRIPPER_COMMAND:
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, controller.max_effort
        return goal
    goal = ParallelGripperCommand.Goal()
    goal.command.name, goal.command.position = [controller.joints[0]], [position]
    if controller.max_effort:
        goal.command.effort = [controller.max_effort]
    return goal
