"""Follows trajectories while the controller is active: measures, samples, checks, commands.

Without a goal tolerance, ros2_controllers ends a goal by time alone. Here a joint that rests far
from its end, because something blocks it or nothing drives it, does not count as arrived. One that
is late but comes closer does.
"""

import logging
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from arm_control.controllers.angles import shortest_angular_distance
from arm_control.controllers.joint_trajectory.commands import CommandWriter, SpeedScaling
from arm_control.controllers.joint_trajectory.configuration import Configuration
from arm_control.controllers.joint_trajectory.goals import (
    CANCELED,
    GOAL_REACHED,
    PATH_TOLERANCE_VIOLATED,
    PREEMPTED,
    REPLACED,
    Bounds,
    ErrorCode,
    GoalCancel,
    GoalRefusal,
    GoalRequest,
    GoalResult,
    GoalStart,
    Motion,
    Request,
    Stop,
    ToleranceError,
    Tolerances,
    TrajectoryReplacement,
    not_checkable,
    stalled,
    too_late,
)
from arm_control.controllers.joint_trajectory.profiles import (
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
    Array,
    MotionProfile,
    StopProfile,
    at_rest,
    completed,
)
from arm_control.controllers.joint_trajectory.state import (
    MOTION_ROWS,
    ActiveGoal,
    ControllerState,
    Progress,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
from arm_control.controllers.joint_trajectory.trajectory import Trajectory
from arm_control.controllers.joint_trajectory.validation import (
    describe_lateness,
    limit_violations,
    velocity_violations,
)
from arm_control.controllers.loaned_interfaces import LoanedInterfaces, describe_unmeasured
from arm_control.state.attributes import load_attributes, save_attributes

FAR = {"rad": 0.05, "m": 0.005}
"""A joint farther than this from its end may have stalled; closer, it is a controller's error."""
STALL_S = 0.5
"""How long such a joint has to come closer."""
CLOSER = 0.1
"""By which fraction of its distance it must have come closer by then."""


@dataclass(slots=True)
class ActiveTrajectory:
    """The profile that the joints follow, and how far they are. Loop thread only.

    Attributes:
        profile: the profile.
        tolerances: the tolerances to check.
        serves_goal: whether a goal ends with it.
        is_stop: whether it only brings the joints to rest: in real time, without a timeout.
        lead_s: time from the profile's start to the start of its trajectory; negative if the
            trajectory should have started earlier.
        elapsed_s: the profile's time.
        age_s: the controller's time since the profile's start; ahead of `elapsed_s` if the speed
            is scaled down.
        is_first: whether this is its first cycle.
        far_at_end: distance of each joint from its end when some were too far, shape (n,).
        far_since_s: `late_s` at that time.
    """

    profile: MotionProfile
    tolerances: Tolerances
    serves_goal: bool = False
    is_stop: bool = False
    lead_s: float = 0.0
    elapsed_s: float = 0.0
    age_s: float = 0.0
    is_first: bool = True
    far_at_end: Array | None = None
    far_since_s: float = 0.0

    def advance(self, period_s: float, speed_scaling: float) -> None:
        """Advance by a period."""
        self.elapsed_s = self.elapsed_after(period_s, speed_scaling)
        self.age_s += period_s
        self.is_first = False

    def elapsed_after(self, period_s: float, speed_scaling: float) -> float:
        """Return the profile's time after another period."""
        return self.elapsed_s + (period_s if self.is_stop else period_s * speed_scaling)

    @property
    def progress(self) -> Progress:
        """Its progress, as times since the start of its trajectory."""
        return Progress(self.elapsed_s - self.lead_s, self.age_s - self.lead_s)

    @property
    def late_s(self) -> float:
        """Time since the end of the profile; negative before it."""
        return self.elapsed_s - self.profile.end_s

    def settle(self) -> None:
        """Stay at the end: no goal waits, and no tolerance is checked any more."""
        self.serves_goal = False
        self.tolerances = self.tolerances.switched_off()
        self.is_stop = True


class TrajectoryTracker:
    """Follows one trajectory after the other, and holds the position in between.

    It exists from activation to deactivation. Loop thread only, except `limit_violations` and
    `velocity_violations`.

    Attributes:
        time_s: the controller's time in the last cycle; None before the first.
        transient: names of attributes that are not part of the state.
    """

    transient: ClassVar[tuple[str, ...]] = (
        "_configuration",
        "_states",
        "_speed_scaling",
        "_sink",
        "_logger",
        "_checked_rows",
    )

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
        self._writer = CommandWriter(configuration, commands)
        self._state = ControllerState(StateLayout.of(configuration.interfaces))
        self._state.speed_scaling = speed_scaling.factor
        self._goal = ActiveGoal(sink, configuration.parameters.action_monitor_rate, logger)
        self._measure()
        position = self._first_position()
        self._commanded = at_rest(position)
        self._active = self._hold(position)
        # While a position is unknown, the first hold waits for the first measurement.
        is_known = bool(np.isfinite(position).all())
        self._next: Motion | None = None if is_known else Stop()
        if sink is not None:
            sink.open(self._state.layout)

    def save_state(self) -> dict[str, Any]:
        """Return the motion and its goal."""
        return save_attributes(self, self.transient)

    def load_state(self, state: Mapping[str, Any]) -> None:
        """Continue with a saved motion; a running goal that it lacks is aborted."""
        load_attributes(self, state)

    def reconfigure(self, configuration: Configuration) -> None:
        """Apply changed parameters."""
        self._configuration = configuration
        self._writer.reconfigure(configuration)
        active = self._active
        if not active.is_stop:
            goal = self._goal.request if active.serves_goal else None
            active.tolerances = self._tolerances(goal)

    def fingerprint(self) -> bytes:
        """Return the numbers of this cycle; those of the profile enter by the sampled set-point."""
        active, integral = self._active, self._writer.save_state()
        flags = (active.serves_goal, active.is_stop, not self._next)
        return b"".join(
            (
                struct.pack("<2d3?", active.elapsed_s, active.age_s, *flags),
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
            self._active, self._next = self._begun(self._next), None
        else:
            self._active.advance(period_s, state.speed_scaling)
        active = self._active
        state.progress = active.progress
        wanted = active.profile.sample(active.elapsed_s)
        state.reference[:] = wanted[: len(state.reference)]
        error = self._compute_error()
        self._goal.give_feedback(state)
        self._check(error)
        self._command(period_s)
        if self._sink is not None:
            self._sink.publish_state(state)

    def _first_position(self) -> Array:
        configuration = self._configuration
        position = self._state.feedback[POSITION].copy()
        if configuration.parameters.set_last_command_interface_value_as_state_on_activation:
            last = self._writer.last_positions()
            if last is not None:
                position[configuration.interfaces.commanded] = last
        return position

    def _measured(self) -> Array:
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

    def _compute_error(self) -> Array:
        """Compute the errors, and return the rows that are checked."""
        state, model = self._state, self._configuration.model
        rows = self._checked_rows
        error = np.subtract(state.reference[:rows], state.feedback[:rows], out=state.error[:rows])
        if model.turns:
            turn = shortest_angular_distance(state.feedback[POSITION], state.reference[POSITION])
            error[POSITION, model.continuous] = turn[model.continuous]
        return error

    def _command(self, period_s: float) -> None:
        scaling, active = self._speed_scaling, self._active
        scaling.refresh(float(self._states.read()[-1]) if scaling.state_names else None)
        # The new factor applies to the period that starts now, so the command is the set-point at
        # its end, and a change of speed or a stop causes no step.
        self._state.speed_scaling = scaling.factor
        self._commanded = active.profile.sample(active.elapsed_after(period_s, scaling.factor))
        self._writer.command(self._state, self._commanded, period_s, scaling.requested)

    # Requests

    def serve(self, requests: Sequence[Request]) -> None:
        """Process the clients' requests; motions change at the next update."""
        for request in requests:
            match request:
                case GoalStart(goal):
                    self._goal.end(PREEMPTED)
                    self._goal.start(goal)
                    self._begin_next(request)
                case TrajectoryReplacement():
                    self._goal.end(REPLACED)
                    self._begin_next(request)
                case GoalCancel(goal_id):
                    if self._goal.request is not None and self._goal.request.id == goal_id:
                        self._goal.end(CANCELED)
                        self._begin_next(Stop())

    def abort(self, requests: Sequence[Request], result: GoalResult) -> None:
        """End every goal with this result, including those among the requests."""
        self.serve(requests)
        self._goal.end(result)

    def write_safe_commands(self) -> None:
        """Leave position commands unchanged, and set all others to 0."""
        self._writer.write_safe_commands()

    def query(self, time_s: float) -> QueriedState:
        """Return the current profile's set-point at a time of the controller's clock."""
        measured = self._measured()[:MOTION_ROWS]
        if self.time_s is None or self._next is not None:
            return QueriedState("no trajectory has started yet", measured)
        profile = self._active.profile
        elapsed_s = self._active.elapsed_s + time_s - self.time_s
        if elapsed_s < -RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is before the start of the trajectory", measured)
        if elapsed_s > profile.end_s + RESOLUTION_S:
            end = profile.sample(max(profile.end_s, 0.0))[:MOTION_ROWS]
            # The profile has a number even for a joint whose position is unknown; report NaN.
            end = np.where(np.isnan(measured[POSITION]), np.nan, end)
            return QueriedState(f"{time_s:f} s is after the end of the trajectory", end)
        return QueriedState("", profile.sample(max(elapsed_s, 0.0))[:MOTION_ROWS])

    def limit_violations(self, trajectory: Trajectory) -> GoalRefusal | None:
        """Return which limit a trajectory violates if it starts now; any thread."""
        configuration = self._configuration
        parameters = configuration.parameters
        if not (parameters.check_position_limits or parameters.check_velocity_limits):
            return None
        times_s = trajectory.times_s + trajectory.offset_s(self.time_s or 0.0)
        positions = np.stack([self._measured()[POSITION], self._commanded[POSITION]])
        return limit_violations(self._profile(trajectory), times_s, positions, configuration)

    def velocity_violations(self, trajectory: Trajectory) -> str | None:
        """Return which joint a trajectory drives too fast if it starts now, or None; any thread.

        The goal is accepted anyway: the joint lags behind, and the tolerances decide.
        """
        return velocity_violations(
            trajectory,
            self._configuration.model,
            self._start()[POSITION],
            trajectory.offset_s(self.time_s or 0.0),
        )

    # Motions

    def _start(self) -> Array:
        """Return the motion to start from; only joints that were never measured are unknown."""
        if self._configuration.parameters.starts_from_command:
            return completed(self._commanded, self._measured())
        return self._present()

    def _present(self) -> Array:
        """Return the measured motion, with the last command for joints that are not measured."""
        return completed(self._measured(), self._commanded)

    def _begin_next(self, motion: Motion) -> None:
        self._active.serves_goal = False
        self._next = motion
        if not np.isfinite(self._start()[POSITION]).all():
            self._logger.warning(
                "%s: the motion starts as soon as every position is known",
                describe_unmeasured(self._unmeasured()),
            )

    def _begun(self, motion: Motion) -> ActiveTrajectory:
        if isinstance(motion, Stop):
            return self._stop()
        trajectory = motion.trajectory
        goal = motion.goal if isinstance(motion, GoalStart) else None
        refusal = self._check_late(trajectory) if trajectory.is_provisional else None
        if refusal is not None:
            return self._refuse(refusal, goal)
        return ActiveTrajectory(
            self._profile(trajectory),
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

    def _refuse(self, refusal: GoalRefusal, goal: GoalRequest | None) -> ActiveTrajectory:
        """Refuse a trajectory after all: keep holding, or stop another motion."""
        if goal is None:
            self._logger.error("%s", refusal.message)
        else:
            self._goal.end(refusal.as_result())
        is_known = bool(np.isfinite(self._commanded[POSITION]).all())
        return self._active if self._active.is_stop and is_known else self._stop()

    def _tolerances(self, goal: GoalRequest | None) -> Tolerances:
        tolerances = self._configuration.tolerances
        if goal is None:
            return tolerances
        try:
            return tolerances.for_goal(goal, self._configuration.interfaces.joints)
        except ToleranceError as error:
            self._logger.error("%s; the default tolerances are used", error)
            return tolerances

    def _profile(self, trajectory: Trajectory) -> MotionProfile:
        configuration = self._configuration
        continuous = configuration.model.continuous
        held = self._present()[POSITION].copy()
        if configuration.interfaces.commands("position"):
            known = completed(self._commanded, self._measured())[POSITION]
            held[configuration.interfaces.commanded] = known[configuration.interfaces.commanded]
        join_s = configuration.parameters.smooth_replacement_time
        return trajectory.profile(self.time_s or 0.0, self._start(), held, continuous, join_s)

    def _stop(self) -> ActiveTrajectory:
        """Brake if that is configured, otherwise hold at once."""
        deceleration = self._configuration.deceleration
        if deceleration is None:
            return self._hold(self._present()[POSITION])
        start = self._start().copy()
        if self._configuration.parameters.starts_from_command:
            start[VELOCITY] *= self._state.speed_scaling
        profile = StopProfile(start[POSITION], np.nan_to_num(start[VELOCITY]), deceleration)
        return self._rest(profile)

    def _hold(self, position: Array) -> ActiveTrajectory:
        return self._rest(StopProfile.hold(position))

    def _rest(self, profile: StopProfile) -> ActiveTrajectory:
        return ActiveTrajectory(
            profile, self._configuration.tolerances.switched_off(), is_stop=True
        )

    def _check(self, error: Array) -> None:
        """Stop if a tolerance is violated; end the goal when its result is known.

        The errors (k, n) are those of position and, if checked, velocity and acceleration.
        """
        active = self._active
        tolerances, late_s = active.tolerances, active.late_s
        has_ended = late_s >= -RESOLUTION_S
        # A profile may have ended before its first cycle; then the path is checked once.
        if (active.is_first or not has_ended) and not tolerances.path.hold(error):
            text = "Holding position due to state tolerance violation"
            self._give_up(PATH_TOLERANCE_VIOLATED, text, tolerances.path, error)
        elif has_ended:
            is_reached = tolerances.goal.hold(error)
            if not is_reached and 0.0 < tolerances.goal_time_s < late_s - RESOLUTION_S:
                text = "Exceeded goal_time_tolerance: holding position..."
                self._give_up(too_late(late_s), text, tolerances.goal, error)
            else:
                self._wait_at_end(is_reached, error)

    def _wait_at_end(self, is_reached: bool, error: Array) -> None:
        """Wait at the end for the goal's result, or for the command timeout."""
        active, timeout_s = self._active, self._configuration.command_timeout_s
        if active.serves_goal:
            unmeasured = self._unmeasured()
            result = self._result(is_reached, error, unmeasured)
            if result is not None:
                self._goal.end(result)
                if result is GOAL_REACHED:
                    active.settle()
                else:
                    self._active = self._stop()
            if result is not None or unmeasured:
                return
        if not active.is_stop and 0.0 < timeout_s < active.late_s - RESOLUTION_S:
            self._logger.warning("Aborted due to command timeout")
            self._active = self._hold(self._present()[POSITION])

    def _result(
        self, is_reached: bool, error: Array, unmeasured: Sequence[str]
    ) -> GoalResult | None:
        """Return the result of the goal, whose profile has ended; None while it has none yet."""
        active, model = self._active, self._configuration.model
        if unmeasured:
            is_late = active.late_s > active.tolerances.goal_time_s - RESOLUTION_S
            return not_checkable(unmeasured) if is_late else None
        if not is_reached:
            return None
        distance = np.abs(error[POSITION])
        far = distance > np.array([FAR[unit] for unit in model.units])
        far &= np.isinf(active.tolerances.goal.values[POSITION])
        far[self._configuration.interfaces.passive] = False
        if not far.any():
            return GOAL_REACHED
        if active.far_at_end is None:
            active.far_at_end, active.far_since_s = distance, active.late_s
            return None
        if active.late_s - active.far_since_s < STALL_S - RESOLUTION_S:
            return None
        resting = far & (distance > (1.0 - CLOSER) * active.far_at_end)
        if not resting.any():
            return GOAL_REACHED
        joint = int(np.flatnonzero(resting)[0])
        return stalled(model.joints[joint], float(distance[joint]), model.units[joint])

    def _give_up(self, result: GoalResult, text: str, bounds: Bounds, error: Array) -> None:
        """Stop, and end the goal with `result`; log `text` if there is no goal."""
        detail = bounds.excess(error, self._configuration.interfaces.joints)
        names = self._unmeasured()
        if names:
            result = replace(result, message=f"{result.message}: {describe_unmeasured(names)}")
        if self._active.serves_goal:
            self._goal.end(result, detail)
        else:
            self._logger.error("%s (%s)", text, detail)
        self._active = self._stop()
