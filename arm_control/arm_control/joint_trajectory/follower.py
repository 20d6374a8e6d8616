"""What the controller does while it is active."""

import logging
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.angles import shortest_way
from arm_control.joint_trajectory.commander import Commander
from arm_control.joint_trajectory.configuration import Configuration
from arm_control.joint_trajectory.execution import Execution, Verdict
from arm_control.joint_trajectory.goal_keeper import GoalKeeper
from arm_control.joint_trajectory.inbox import GoalCancel, GoalStart, Replacement, Request
from arm_control.joint_trajectory.motion import (
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
    at_rest,
)
from arm_control.joint_trajectory.plans import Plan, StopPlan
from arm_control.joint_trajectory.requests import GoalRequest
from arm_control.joint_trajectory.results import (
    CANCELED,
    DEACTIVATED,
    GOAL_REACHED,
    PATH_TOLERANCE_VIOLATED,
    PREEMPTED,
    REPLACED,
    ErrorCode,
    GoalResult,
    Refusal,
    too_late,
)
from arm_control.joint_trajectory.speed_scaling import SpeedScaling
from arm_control.joint_trajectory.state import (
    MOTION_ROWS,
    ControllerState,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
from arm_control.joint_trajectory.tolerances import Bounds, ToleranceError, Tolerances
from arm_control.joint_trajectory.trajectory import Trajectory
from arm_control.joint_trajectory.validation import describe_lateness
from arm_control.loaned_interfaces import LoanedInterfaces


class Follower:
    """Follows one trajectory after the other, and holds still in between.

    Made at activation, thrown away at deactivation. Loop thread only, but for `find_excess`
    and `find_haste`.

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
        """Hold what was commanded last, or else where the joints are.

        Args:
            configuration: of the controller.
            commands: its command interfaces.
            states: its state interfaces.
            speed_scaling: how fast trajectory time runs.
            sink: where the news go.
            logger: the controller's.
        """
        self.time_s: float | None = None
        self._configuration = configuration
        self._states = states
        self._speed_scaling = speed_scaling
        self._sink = sink
        self._logger = logger
        self._checked_rows = configuration.wiring.checked_rows
        self._commander = Commander(configuration, commands)
        self._state = ControllerState(StateLayout.of(configuration.wiring))
        self._state.speed_scaling = speed_scaling.factor
        self._goals = GoalKeeper(sink, configuration.parameters.action_monitor_rate, logger)
        self._measure()
        position = self._first_position()
        self._commanded = at_rest(position)
        self._execution = self._hold(position)
        # A hold of what is not known yet gives way to one where the joints turn out to be.
        is_known = bool(np.isfinite(position).all())
        self._next: Callable[[], Execution] | None = None if is_known else self._stop
        if sink is not None:
            sink.open(self._state.layout)

    def reconfigure(self, configuration: Configuration) -> None:
        """Go on with other parameters."""
        self._configuration = configuration
        self._commander.reconfigure(configuration)
        execution = self._execution
        if not execution.is_stop:
            goal = self._goals.goal if execution.serves_goal else None
            execution.tolerances = self._tolerances(goal)

    # Cycles

    def update(self, time_s: float, period_s: float) -> None:
        """Measure, judge, command and report."""
        state = self._state
        state.time_s = self.time_s = time_s
        self._measure()
        if self._next is not None and np.isfinite(self._start()[POSITION]).all():
            self._execution, self._next = self._next(), None
        else:
            self._execution.advance(period_s, state.speed_scaling)
        execution = self._execution
        state.progress = execution.progress
        wanted = execution.plan.sample(execution.elapsed_s)
        state.reference[:] = wanted[: len(state.reference)]
        error = self._compute_error()
        self._goals.give_feedback(state, period_s)
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
                position[configuration.wiring.commanded] = last
        return position

    def _measured(self) -> NDArray[np.float64]:
        feedback = self._state.feedback
        motion = np.full((ROWS, feedback.shape[1]), np.nan)
        motion[: len(feedback)] = feedback
        return motion

    def _measure(self) -> None:
        self._state.feedback[:] = self._states.read()[self._configuration.wiring.state_index]

    def _compute_error(self) -> NDArray[np.float64]:
        """Fill in the errors, and return the rows that count."""
        state, model = self._state, self._configuration.model
        rows = self._checked_rows
        error = np.subtract(state.reference[:rows], state.feedback[:rows], out=state.error[:rows])
        if model.turns:
            way = shortest_way(state.feedback[POSITION], state.reference[POSITION])
            error[POSITION, model.continuous] = way[model.continuous]
        return error

    def _command(self, period_s: float) -> None:
        scaling, execution = self._speed_scaling, self._execution
        scaling.refresh(float(self._states.read()[-1]) if scaling.state_names else None)
        # The factor now in force counts for the period that begins: so the command for its end is
        # what will be wanted then, and a change of speed, or a standstill, makes no step.
        self._state.speed_scaling = scaling.factor
        self._commanded = execution.plan.sample(execution.elapsed_after(period_s, scaling.factor))
        self._commander.command(self._state, self._commanded, period_s, scaling.requested)

    # Requests

    def serve(self, requests: Sequence[Request]) -> None:
        """Take over what clients ask for; motions change at the next update."""
        for request in requests:
            match request:
                case GoalStart(goal, trajectory):
                    self._goals.end(PREEMPTED)
                    self._goals.start(goal)
                    self._begin_next(partial(self._follow, trajectory, goal))
                case Replacement(trajectory):
                    self._goals.end(REPLACED)
                    self._begin_next(partial(self._follow, trajectory))
                case GoalCancel(goal_id):
                    if self._goals.goal is not None and self._goals.goal.id == goal_id:
                        self._goals.end(CANCELED)
                        self._begin_next(self._stop)

    def close(self, requests: Sequence[Request]) -> None:
        """Abort every goal, those still among the requests too; leave the commands safe."""
        self.serve(requests)
        self._goals.end(DEACTIVATED)
        self._commander.let_go()

    def query(self, time_s: float) -> QueriedState:
        """Return what the present plan wants at a time of the controller's clock."""
        measured = self._measured()[:MOTION_ROWS]
        if self.time_s is None or self._next is not None:
            return QueriedState("there is no trajectory under way yet", measured)
        plan = self._execution.plan
        elapsed_s = self._execution.elapsed_s + time_s - self.time_s
        if elapsed_s < -RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is before the start of the trajectory", measured)
        if elapsed_s > plan.end_s + RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is after the end of the trajectory", measured)
        return QueriedState("", plan.sample(max(elapsed_s, 0.0))[:MOTION_ROWS])

    def find_excess(self, trajectory: Trajectory) -> Refusal | None:
        """Return which limit a trajectory breaks if it begins now; any thread."""
        limits = self._configuration.limits
        if limits is None:
            return None
        offset_s = trajectory.offset_s(self.time_s or 0.0)
        places = np.stack([self._measured()[POSITION], self._commanded[POSITION]])
        return limits.find_excess(self._plan(trajectory), trajectory.times_s + offset_s, places)

    def find_haste(self, trajectory: Trajectory) -> str | None:
        """Say which joint is too slow for a trajectory that begins now, None for none; any thread.

        It is no reason to refuse it: the joint lags behind, and the tolerances judge that.
        """
        offset_s = trajectory.offset_s(self.time_s or 0.0)
        return self._configuration.model.find_haste(trajectory, self._start()[POSITION], offset_s)

    # Motions

    def _start(self) -> NDArray[np.float64]:
        """Return the motion to go on from: a position is unknown only where nobody ever knew it."""
        if self._configuration.starts_from_command:
            return _completed(self._commanded, self._measured())
        return self._present()

    def _present(self) -> NDArray[np.float64]:
        """Return the motion of the joints, at what was commanded last where none is measured."""
        return _completed(self._measured(), self._commanded)

    def _begin_next(self, begin: Callable[[], Execution]) -> None:
        self._execution.serves_goal = False
        self._next = begin

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

    def _check_late(self, trajectory: Trajectory) -> Refusal | None:
        """Return what is wrong with a trajectory that was taken before the time was known."""
        lateness = describe_lateness(
            trajectory.stamp_s, float(trajectory.times_s[-1]), self.time_s or 0.0
        )
        if lateness:
            return Refusal(ErrorCode.INVALID_GOAL, lateness)
        return self.find_excess(trajectory)

    def _refuse(self, refusal: Refusal, goal: GoalRequest | None) -> Execution:
        """Do not follow a trajectory after all: hold on, or stop where something else moved."""
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
            return tolerances.for_goal(goal, self._configuration.wiring.joints)
        except ToleranceError as error:
            self._logger.error("%s; the default tolerances are used", error)
            return tolerances

    def _plan(self, trajectory: Trajectory) -> Plan:
        configuration = self._configuration
        continuous = configuration.model.continuous
        held = self._present()[POSITION].copy()
        if configuration.wiring.commands("position"):
            known = _completed(self._commanded, self._measured())[POSITION]
            held[configuration.wiring.commanded] = known[configuration.wiring.commanded]
        join_s = configuration.parameters.smooth_replacement_time
        return trajectory.plan(self.time_s or 0.0, self._start(), held, continuous, join_s)

    def _stop(self) -> Execution:
        """Brake where that is configured, else hold at once."""
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

    def _conclude(self, verdict: Verdict, error: NDArray[np.float64]) -> None:
        """Draw the consequences of a verdict."""
        execution = self._execution
        tolerances, late_s = execution.tolerances, execution.late_s
        timeout_s = self._configuration.command_timeout_s
        if verdict is Verdict.OFF_THE_PATH:
            text = "Holding position due to state tolerance violation"
            self._give_up(PATH_TOLERANCE_VIOLATED, text, tolerances.path, error)
        elif verdict is Verdict.TOO_LATE:
            text = "Exceeded goal_time_tolerance: holding position..."
            self._give_up(too_late(late_s), text, tolerances.goal, error)
        elif verdict is Verdict.AT_THE_GOAL and execution.serves_goal:
            self._goals.end(GOAL_REACHED)
            execution.settle()
        elif not execution.is_stop and 0.0 < timeout_s < late_s - RESOLUTION_S:
            self._logger.warning("Aborted due to command timeout")
            self._execution = self._hold(self._present()[POSITION])

    def _give_up(
        self, result: GoalResult, text: str, bounds: Bounds, error: NDArray[np.float64]
    ) -> None:
        """Stop, and end the goal with `result`; say `text` where there is no goal."""
        detail = bounds.excess(error, self._configuration.wiring.joints)
        if self._execution.serves_goal:
            self._goals.end(result, detail)
        else:
            self._logger.error("%s (%s)", text, detail)
        self._execution = self._stop()


def _completed(motion: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a motion with the positions of another where its own are not known."""
    known = np.isfinite(motion[POSITION])
    if known.all():
        return motion
    completed = motion.copy()
    completed[POSITION] = np.where(known, motion[POSITION], other[POSITION])
    return completed
