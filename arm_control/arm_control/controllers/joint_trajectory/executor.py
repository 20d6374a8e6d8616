"""Executes trajectories while the controller is active, and turns set-points into commands."""

import logging
import struct
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.angles import shortest_angular_distance
from arm_control.controllers.joint_trajectory.execution import (
    ActiveGoal,
    Execution,
    ExecutionStatus,
    GoalCancel,
    GoalStart,
    Motion,
    Request,
    SpeedScaling,
    Stop,
    TrajectoryReplacement,
    result_at_end,
)
from arm_control.controllers.joint_trajectory.goals import (
    CANCELED,
    GOAL_REACHED,
    PATH_TOLERANCE_VIOLATED,
    PREEMPTED,
    REPLACED,
    Bounds,
    ErrorCode,
    GoalRefusal,
    GoalRequest,
    GoalResult,
    ToleranceError,
    Tolerances,
    too_late,
)
from arm_control.controllers.joint_trajectory.parameters import Configuration
from arm_control.controllers.joint_trajectory.plans import (
    EFFORT,
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
    MotionPlan,
    StopPlan,
    at_rest,
    completed,
)
from arm_control.controllers.joint_trajectory.state import (
    MOTION_ROWS,
    ControllerState,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
from arm_control.controllers.joint_trajectory.trajectory import Trajectory
from arm_control.controllers.joint_trajectory.validation import describe_lateness
from arm_control.controllers.loaned_interfaces import LoanedInterfaces, describe_unmeasured
from arm_control.controllers.pid import Pid

ENDED = (ExecutionStatus.GOAL_REACHED, ExecutionStatus.SETTLING)


class TrajectoryExecutor:
    """Executes one trajectory after the other, and holds the position in between.

    It exists from activation to deactivation. Loop thread only, except `limit_violations` and
    `velocity_violations`.

    Attributes:
        time_s: the controller's time in the last cycle; None before the first.
    """

    def __init__(
        self,
        configuration: Configuration,
        commands: LoanedInterfaces,
        states: LoanedInterfaces,
        speed_scaling: SpeedScaling,
        sink: TrajectorySink | None,
        logger: logging.Logger,
    ) -> None:
        """Hold the last commanded position, or else the measured one."""
        self.time_s: float | None = None
        self._configuration = configuration
        self._states = states
        self._speed_scaling = speed_scaling
        self._sink = sink
        self._logger = logger
        self._checked_rows = configuration.interfaces.checked_rows
        self._commander = Commander(configuration, commands)
        self._state = ControllerState(StateLayout.of(configuration.interfaces))
        self._state.speed_scaling = speed_scaling.factor
        self._goals = ActiveGoal(sink, configuration.parameters.action_monitor_rate, logger)
        self._measure()
        position = self._first_position()
        self._commanded = at_rest(position)
        self._execution = self._hold(position)
        # While a position is unknown, the first hold waits for the first measurement.
        is_known = bool(np.isfinite(position).all())
        self._next: Motion | None = None if is_known else Stop()
        if sink is not None:
            sink.open(self._state.layout)

    def reconfigure(self, configuration: Configuration) -> None:
        """Apply changed parameters."""
        self._configuration = configuration
        self._commander.reconfigure(configuration)
        execution = self._execution
        if not execution.is_stop:
            goal = self._goals.goal if execution.serves_goal else None
            execution.tolerances = self._tolerances(goal)

    def fingerprint(self) -> bytes:
        """Return the numbers of this cycle; those of the plan enter by the sampled set-point."""
        execution, integral = self._execution, self._commander.save_state()
        flags = (execution.serves_goal, execution.is_stop, not self._next)
        return b"".join(
            (
                struct.pack("<2d3?", execution.elapsed_s, execution.age_s, *flags),
                self._commanded.tobytes(),
                self._state.values.tobytes(),
                b"" if integral is None else integral.tobytes(),
            )
        )

    # Cycles

    def update(self, time_s: float, period_s: float) -> None:
        """Measure, check the progress, command and publish."""
        state = self._state
        state.time_s = self.time_s = time_s
        self._measure()
        if self._next is not None and np.isfinite(self._start()[POSITION]).all():
            self._execution, self._next = self._begun(self._next), None
        else:
            self._execution.advance(period_s, state.speed_scaling)
        execution = self._execution
        state.progress = execution.progress
        wanted = execution.plan.sample(execution.elapsed_s)
        state.reference[:] = wanted[: len(state.reference)]
        error = self._compute_error()
        self._goals.give_feedback(state)
        self._conclude(execution.judge(error), error)
        self._command(period_s)
        if self._sink is not None:
            self._sink.publish_state(state)

    def _first_position(self) -> NDArray[np.float64]:
        configuration = self._configuration
        position = self._state.feedback[POSITION].copy()
        if configuration.parameters.set_last_command_interface_value_as_state_on_activation:
            last = self._commander.last_positions()
            if last is not None:
                position[configuration.interfaces.commanded] = last
        return position

    def _measured(self) -> NDArray[np.float64]:
        feedback = self._state.feedback
        motion = np.full((ROWS, feedback.shape[1]), np.nan)
        motion[: len(feedback)] = feedback
        return motion

    def _unmeasured(self) -> tuple[str, ...]:
        """Return the names of the measured states that are not numbers."""
        names = self._states.names
        index = self._configuration.interfaces.state_index[~np.isfinite(self._state.feedback)]
        return tuple(names[i] for i in sorted(index.tolist()))

    def _measure(self) -> None:
        self._state.feedback[:] = self._states.read()[self._configuration.interfaces.state_index]

    def _compute_error(self) -> NDArray[np.float64]:
        """Compute the errors, and return the rows that are checked."""
        state, model = self._state, self._configuration.model
        rows = self._checked_rows
        error = np.subtract(state.reference[:rows], state.feedback[:rows], out=state.error[:rows])
        if model.turns:
            turn = shortest_angular_distance(state.feedback[POSITION], state.reference[POSITION])
            error[POSITION, model.continuous] = turn[model.continuous]
        return error

    def _command(self, period_s: float) -> None:
        scaling, execution = self._speed_scaling, self._execution
        scaling.refresh(float(self._states.read()[-1]) if scaling.state_names else None)
        # The new factor applies to the period that starts now, so the command is the set-point at
        # its end, and a change of speed or a stop causes no step.
        self._state.speed_scaling = scaling.factor
        self._commanded = execution.plan.sample(execution.elapsed_after(period_s, scaling.factor))
        self._commander.command(self._state, self._commanded, period_s, scaling.requested)

    # Requests

    def serve(self, requests: Sequence[Request]) -> None:
        """Process the clients' requests; motions change at the next update."""
        for request in requests:
            match request:
                case GoalStart(goal):
                    self._goals.end(PREEMPTED)
                    self._goals.start(goal)
                    self._begin_next(request)
                case TrajectoryReplacement():
                    self._goals.end(REPLACED)
                    self._begin_next(request)
                case GoalCancel(goal_id):
                    if self._goals.goal is not None and self._goals.goal.id == goal_id:
                        self._goals.end(CANCELED)
                        self._begin_next(Stop())

    def abort(self, requests: Sequence[Request], result: GoalResult) -> None:
        """End every goal with this result, including those among the requests."""
        self.serve(requests)
        self._goals.end(result)

    def write_safe_commands(self) -> None:
        """Leave position commands unchanged, and set all others to 0."""
        self._commander.write_safe_commands()

    def query(self, time_s: float) -> QueriedState:
        """Return the current plan's set-point at a time of the controller's clock."""
        measured = self._measured()[:MOTION_ROWS]
        if self.time_s is None or self._next is not None:
            return QueriedState("no trajectory has started yet", measured)
        plan = self._execution.plan
        elapsed_s = self._execution.elapsed_s + time_s - self.time_s
        if elapsed_s < -RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is before the start of the trajectory", measured)
        if elapsed_s > plan.end_s + RESOLUTION_S:
            end = plan.sample(max(plan.end_s, 0.0))[:MOTION_ROWS]
            # The plan has a number even for a joint whose position is unknown; report NaN.
            end = np.where(np.isnan(measured[POSITION]), np.nan, end)
            return QueriedState(f"{time_s:f} s is after the end of the trajectory", end)
        return QueriedState("", plan.sample(max(elapsed_s, 0.0))[:MOTION_ROWS])

    def limit_violations(self, trajectory: Trajectory) -> GoalRefusal | None:
        """Return which limit a trajectory violates if it starts now; any thread."""
        limits = self._configuration.limits
        if limits is None:
            return None
        offset_s = trajectory.offset_s(self.time_s or 0.0)
        positions = np.stack([self._measured()[POSITION], self._commanded[POSITION]])
        return limits.limit_violations(
            self._plan(trajectory), trajectory.times_s + offset_s, positions
        )

    def velocity_violations(self, trajectory: Trajectory) -> str | None:
        """Return which joint a trajectory drives too fast if it starts now, or None; any thread.

        The goal is accepted anyway: the joint lags behind, and the tolerances decide.
        """
        offset_s = trajectory.offset_s(self.time_s or 0.0)
        return self._configuration.model.velocity_violations(
            trajectory, self._start()[POSITION], offset_s
        )

    # Motions

    def _start(self) -> NDArray[np.float64]:
        """Return the motion to start from; only joints that were never measured are unknown."""
        if self._configuration.starts_from_command:
            return completed(self._commanded, self._measured())
        return self._present()

    def _present(self) -> NDArray[np.float64]:
        """Return the measured motion, with the last command for joints that are not measured."""
        return completed(self._measured(), self._commanded)

    def _begin_next(self, motion: Motion) -> None:
        self._execution.serves_goal = False
        self._next = motion
        if not np.isfinite(self._start()[POSITION]).all():
            self._logger.warning(
                "%s: the motion starts as soon as every position is known",
                describe_unmeasured(self._unmeasured()),
            )

    def _begun(self, motion: Motion) -> Execution:
        if isinstance(motion, Stop):
            return self._stop()
        return self._follow(
            motion.trajectory, motion.goal if isinstance(motion, GoalStart) else None
        )

    def _follow(self, trajectory: Trajectory, goal: GoalRequest | None = None) -> Execution:
        refusal = self._check_late(trajectory) if trajectory.is_provisional else None
        if refusal is not None:
            return self._refuse(refusal, goal)
        return Execution(
            self._plan(trajectory),
            self._tolerances(goal),
            serves_goal=goal is not None,
            lead_s=trajectory.offset_s(self.time_s or 0.0),
        )

    def _check_late(self, trajectory: Trajectory) -> GoalRefusal | None:
        """Check a trajectory that was accepted before the time was known."""
        lateness = describe_lateness(
            trajectory.stamp_s, float(trajectory.times_s[-1]), self.time_s or 0.0
        )
        if lateness:
            return GoalRefusal(ErrorCode.INVALID_GOAL, lateness)
        return self.limit_violations(trajectory)

    def _refuse(self, refusal: GoalRefusal, goal: GoalRequest | None) -> Execution:
        """Refuse a trajectory after all: keep holding, or stop another motion."""
        if goal is None:
            self._logger.error("%s", refusal.message)
        else:
            self._goals.end(refusal.as_result())
        is_known = bool(np.isfinite(self._commanded[POSITION]).all())
        return self._execution if self._execution.is_stop and is_known else self._stop()

    def _tolerances(self, goal: GoalRequest | None) -> Tolerances:
        tolerances = self._configuration.tolerances
        if goal is None:
            return tolerances
        try:
            return tolerances.for_goal(goal, self._configuration.interfaces.joints)
        except ToleranceError as error:
            self._logger.error("%s; the default tolerances are used", error)
            return tolerances

    def _plan(self, trajectory: Trajectory) -> MotionPlan:
        configuration = self._configuration
        continuous = configuration.model.continuous
        held = self._present()[POSITION].copy()
        if configuration.interfaces.commands("position"):
            known = completed(self._commanded, self._measured())[POSITION]
            held[configuration.interfaces.commanded] = known[configuration.interfaces.commanded]
        join_s = configuration.parameters.smooth_replacement_time
        return trajectory.plan(self.time_s or 0.0, self._start(), held, continuous, join_s)

    def _stop(self) -> Execution:
        """Brake if that is configured, otherwise hold at once."""
        deceleration = self._configuration.deceleration
        if deceleration is None:
            return self._hold(self._present()[POSITION])
        start = self._start().copy()
        if self._configuration.starts_from_command:
            start[VELOCITY] *= self._state.speed_scaling
        plan = StopPlan(start[POSITION], np.nan_to_num(start[VELOCITY]), deceleration)
        return self._rest(plan)

    def _hold(self, position: NDArray[np.float64]) -> Execution:
        return self._rest(StopPlan.hold(position))

    def _rest(self, plan: StopPlan) -> Execution:
        return Execution(plan, self._configuration.tolerances.switched_off(), is_stop=True)

    def _conclude(self, status: ExecutionStatus, error: NDArray[np.float64]) -> None:
        """Act on the status of the execution."""
        execution = self._execution
        tolerances, late_s = execution.tolerances, execution.late_s
        timeout_s = self._configuration.command_timeout_s
        if execution.serves_goal and status in ENDED:
            names = self._unmeasured()
            result = result_at_end(status, execution, error, names, self._configuration)
            if result is not None:
                self._goals.end(result)
                if result is GOAL_REACHED:
                    execution.settle()
                else:
                    self._execution = self._stop()
            if result is not None or names:
                return
        if status is ExecutionStatus.PATH_TOLERANCE_VIOLATED:
            text = "Holding position due to state tolerance violation"
            self._give_up(PATH_TOLERANCE_VIOLATED, text, tolerances.path, error)
        elif status is ExecutionStatus.GOAL_TIME_EXCEEDED:
            text = "Exceeded goal_time_tolerance: holding position..."
            self._give_up(too_late(late_s), text, tolerances.goal, error)
        elif not execution.is_stop and 0.0 < timeout_s < late_s - RESOLUTION_S:
            self._logger.warning("Aborted due to command timeout")
            self._execution = self._hold(self._present()[POSITION])

    def _give_up(
        self, result: GoalResult, text: str, bounds: Bounds, error: NDArray[np.float64]
    ) -> None:
        """Stop, and end the goal with `result`; log `text` if there is no goal."""
        detail = bounds.excess(error, self._configuration.interfaces.joints)
        names = self._unmeasured()
        if names:
            result = replace(result, message=f"{result.message}: {describe_unmeasured(names)}")
        if self._execution.serves_goal:
            self._goals.end(result, detail)
        else:
            self._logger.error("%s (%s)", text, detail)
        self._execution = self._stop()


class Commander:
    """Computes and writes the commands of one activation. Loop thread only.

    Position, velocity and acceleration commands are the set-points at the end of the period, when
    they have taken effect; effort commands are the present set-points. If the only command is a
    velocity or an effort, a PID controller computes it from the errors.
    """

    def __init__(self, configuration: Configuration, commands: LoanedInterfaces) -> None:
        """Take the command interfaces; the last may be the one for the speed scaling factor."""
        interfaces = configuration.interfaces
        self._commands = commands
        self._interfaces = interfaces
        self._pid = Pid(configuration.gains) if configuration.gains else None
        self._feedforward = configuration.feedforward
        rows = [row for row in interfaces.command_rows if row != EFFORT]
        self._forwarded_rows = slice(rows[0], rows[-1] + 1) if rows else slice(0, 0)
        self._commands_effort = EFFORT in interfaces.command_rows
        self._passive = np.setdiff1d(np.arange(len(interfaces.joints)), interfaces.commanded)
        self._commands_scaling = len(commands) > len(interfaces.command_names)

    def reconfigure(self, configuration: Configuration) -> None:
        """Apply changed gains."""
        self._feedforward = configuration.feedforward
        if self._pid is not None:
            self._pid.set_gains(configuration.gains)

    def save_state(self) -> NDArray[np.float64] | None:
        """Return the integrals of the PID controller, shape (k,), if there is one."""
        return None if self._pid is None else self._pid.save_state()

    def load_state(self, state: NDArray[np.float64] | None) -> None:
        """Set the integrals."""
        if self._pid is not None and state is not None:
            self._pid.load_state(state)

    def last_positions(self) -> NDArray[np.float64] | None:
        """Return the last commanded positions, shape (k,) for k commanded joints.

        Returns:
            None if positions are not commanded, or if any command is unknown.
        """
        names = self._interfaces.command_names
        values = self._commands.read()[: len(names)]
        positions = [i for i, name in enumerate(names) if name.endswith("/position")]
        return values[positions] if positions and np.isfinite(values).all() else None

    def command(
        self,
        state: ControllerState,
        upcoming: NDArray[np.float64],
        period_s: float,
        requested_scaling: float,
    ) -> None:
        """Compute `state.output` and write it.

        Args:
            state: the current state, including its errors.
            upcoming: set-point at the end of the period, shape (4, n).
            period_s: length of the period.
            requested_scaling: speed scaling factor, for hardware that supports it.
        """
        output = state.output
        if self._pid is not None:
            output[0] = self._pid.update(state.error[POSITION], state.error[VELOCITY], period_s)
            output[0] += self._feedforward * upcoming[VELOCITY]
            if self._commands_effort:
                output[0] += state.reference[EFFORT]
        else:
            forwarded = upcoming[self._forwarded_rows]
            output[: len(forwarded)] = forwarded
            if self._commands_effort:
                output[-1] = state.reference[EFFORT]
        if len(self._passive):
            output[:, self._passive] = np.nan
        values = output.reshape(-1)[self._interfaces.command_index]
        if self._commands_scaling:
            values = np.append(values, requested_scaling)
        self._commands.write(values)

    def write_safe_commands(self) -> None:
        """Leave position commands unchanged, and set all others to 0."""
        values = self._commands.read().copy()
        for i, name in enumerate(self._interfaces.command_names):
            if not name.endswith("/position"):
                values[i] = 0.0
        self._commands.write(values)
