"""joint_trajectory_controller/JointTrajectoryController: follows trajectories of the joints."""

from collections.abc import Callable, Mapping
from functools import partial
from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.joint_trajectory.angles import shortest_way
from arm_control.joint_trajectory.commander import Commander
from arm_control.joint_trajectory.configuration import Configuration
from arm_control.joint_trajectory.execution import Execution, Verdict
from arm_control.joint_trajectory.inbox import GoalCancel, GoalStart, Inbox, Replacement
from arm_control.joint_trajectory.motion import POSITION, RESOLUTION_S, ROWS, VELOCITY, at_rest
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.joint_trajectory.plans import BlendedPlan, Plan, StopPlan
from arm_control.joint_trajectory.requests import GoalRequest, TrajectoryRequest
from arm_control.joint_trajectory.results import (
    CANCELED,
    DEACTIVATED,
    GOAL_REACHED,
    NOT_RUNNING,
    PATH_TOLERANCE_VIOLATED,
    PREEMPTED,
    REPLACED,
    GoalResult,
    Outcome,
    Refusal,
    too_late,
)
from arm_control.joint_trajectory.speed_scaling import SpeedScaling
from arm_control.joint_trajectory.state import (
    MOTION_ROWS,
    ControllerState,
    Feedback,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
from arm_control.joint_trajectory.tolerances import ToleranceError, Tolerances
from arm_control.joint_trajectory.trajectory import Trajectory
from arm_control.joint_trajectory.validation import find_fault
from arm_control.parameters import ParameterSpec
from arm_description.errors import DescriptionError
from arm_description.robot import Robot
from arm_description.urdf import parse_urdf


class JointTrajectoryController(Controller[JointTrajectoryParameters]):
    """Follows trajectories that come as goals of an action or on a topic, else holds still.

    Requests come in on any thread. They take effect at the next update, or as soon as somebody
    calls `serve_requests` on the loop thread: then a goal is cancelled or preempted even while the
    simulation stands still.

    Attributes:
        sink: where the news go; None drops them. Set it before activation.
    """

    parameters_type: ClassVar[type[Any]] = JointTrajectoryParameters

    _configuration: Configuration
    _speed_scaling: SpeedScaling
    _commander: Commander
    _state: ControllerState
    _execution: Execution
    _commanded: NDArray[np.float64]

    def __init__(self, context: ControllerContext) -> None:
        """Read the robot description.

        Raises:
            ControllerError: it cannot be read.
        """
        super().__init__(context)
        self.sink: TrajectorySink | None = None
        self._robot = _read_robot(context.robot_description)
        self._inbox = Inbox()
        self._goal: GoalRequest | None = None
        self._next: Callable[[], Execution] | None = None
        self._time_s = -inf
        self._feedback_wait_s = 0.0

    @classmethod
    def parameter_specs(cls, given: Mapping[str, Any]) -> tuple[ParameterSpec, ...]:
        """Return the parameters that there are for the joints among the given parameters."""
        return JointTrajectoryParameters.specs(given)

    @classmethod
    def build_parameters(cls, values: Mapping[str, Any]) -> JointTrajectoryParameters:
        """Return parameters from values by full name.

        Raises:
            ParameterError: a name is unknown, or a value cannot be used.
        """
        return JointTrajectoryParameters.build(values)

    # Requests: any thread

    def check_goal(self, trajectory: TrajectoryRequest) -> Refusal | None:
        """Return why a goal with this trajectory is to be rejected, None where it is not."""
        if not self._inbox.is_open:
            self.logger.error("%s", NOT_RUNNING.message)
            return NOT_RUNNING
        prepared = self._prepare(trajectory)
        return prepared if isinstance(prepared, Refusal) else None

    def submit_goal(self, goal: GoalRequest) -> GoalResult | None:
        """Start a goal that was accepted; it takes the place of the one before.

        Returns:
            None: the sink will hear of the end. A result where the goal has ended already, because
            it has a fault or the controller is not running: the sink will not hear of it.
        """
        if not self._inbox.is_open:
            return NOT_RUNNING.as_result()
        prepared = self._prepare(goal.trajectory)
        if isinstance(prepared, Refusal):
            return prepared.as_result()
        taken = self._inbox.put(GoalStart(goal, prepared))
        return None if taken else NOT_RUNNING.as_result()

    def cancel_goal(self, goal_id: object) -> None:
        """End a goal, and stop; nothing happens where it has ended already."""
        self._inbox.put(GoalCancel(goal_id))

    def submit_trajectory(self, trajectory: TrajectoryRequest) -> Refusal | None:
        """Follow a trajectory without a goal; dropped in silence while not running.

        Returns:
            Why it is not followed, which is in the log, too.
        """
        if not self._inbox.is_open:
            return None
        prepared = self._prepare(trajectory)
        if isinstance(prepared, Refusal):
            return prepared
        self._inbox.put(Replacement(prepared))
        return None

    def request_speed_scaling(self, factor: float) -> bool:
        """Let trajectory time run at a factor; return whether that is possible."""
        return self._speed_scaling.request(factor)

    # Life cycle: loop thread

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim each interface of each command joint."""
        return InterfaceConfiguration.individual(
            self._configuration.wiring.command_names + self._speed_scaling.command_names
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read each interface of each joint."""
        return InterfaceConfiguration.individual(
            self._configuration.wiring.state_names + self._speed_scaling.state_names
        )

    def on_configure(self, parameters: JointTrajectoryParameters) -> None:
        """Take the parameters.

        Raises:
            ControllerError, ParameterError: they cannot be used.
        """
        if parameters.open_loop_control:
            self.logger.warning(
                "parameter 'open_loop_control' is deprecated: use 'interpolate_from_desired_state'"
            )
        self._configuration = Configuration.of(parameters, self._robot, self.logger)
        self._speed_scaling = SpeedScaling(parameters.speed_scaling, self.logger)

    def update_parameters(self, parameters: JointTrajectoryParameters) -> None:
        """Take parameters that changed while configured; read-only ones are as before.

        Raises:
            ControllerError, ParameterError: they cannot be used; the old ones stay.
        """
        before = self._configuration
        self._configuration = Configuration.of(parameters, self._robot, self.logger)
        if self._inbox.is_open:
            self._commander.reconfigure(self._configuration)
            if self._execution.tolerances is before.tolerances:
                self._execution.tolerances = self._configuration.tolerances

    def on_activate(self) -> None:
        """Hold what was commanded last, or else where the joints are."""
        configuration = self._configuration
        self._state = ControllerState(StateLayout.of(configuration.wiring))
        self._commander = Commander(configuration, self.commands)
        self._time_s = -inf
        self._next = None
        self._measure()
        position = self._state.feedback[POSITION].copy()
        if configuration.parameters.set_last_command_interface_value_as_state_on_activation:
            last = self._commander.last_positions()
            if last is not None:
                position[configuration.wiring.commanded] = last
        self._commanded = at_rest(position)
        self._execution = self._hold(position)
        if self.sink is not None:
            self.sink.open(self._state.layout)
        self._inbox.open()

    def on_deactivate(self) -> None:
        """Abort the goal; positions stay commanded, everything else becomes zero."""
        for request in self._inbox.close():
            if isinstance(request, GoalStart):
                self._end_goal(PREEMPTED)
                self._goal = request.goal
        self._end_goal(DEACTIVATED)
        self._commander.let_go()

    # One cycle: loop thread

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Measure, judge, command and report."""
        if self._inbox:
            self.serve_requests()
        state = self._state
        state.time_s = self._time_s = time_s
        self._measure()
        if self._next is not None:
            self._execution, self._next = self._next(), None
        else:
            self._execution.advance(period_s, state.speed_scaling)
        execution = self._execution
        wanted = execution.plan.sample(execution.elapsed_s)
        state.reference[:] = wanted[: len(state.reference)]
        error = self._compute_error()
        self._give_feedback(period_s)
        self._conclude(execution.judge(error), error)
        self._refresh_speed_scaling()
        self._command(period_s)
        if self.sink is not None:
            self.sink.publish_state(state)
        return ReturnType.OK

    def serve_requests(self) -> None:
        """Take over what clients have asked for; a new motion begins at the next update."""
        for request in self._inbox.take():
            match request:
                case GoalStart(goal, trajectory):
                    self._end_goal(PREEMPTED)
                    self._goal = goal
                    self._feedback_wait_s = 0.0
                    self._next = partial(self._follow, trajectory, goal)
                case Replacement(trajectory):
                    self._end_goal(REPLACED)
                    self._next = partial(self._follow, trajectory)
                case GoalCancel(goal_id) if self._goal and self._goal.id == goal_id:
                    self._end_goal(CANCELED)
                    self._next = self._stop
                case GoalCancel():
                    pass

    def query_state(self, time_s: float) -> QueriedState:
        """Return what the present trajectory wants at a time of the controller's clock."""
        if not self._inbox.is_open:
            return QueriedState("the controller is not active", np.full((MOTION_ROWS, 0), np.nan))
        measured = self._measured()[:MOTION_ROWS]
        plan = self._execution.plan
        elapsed_s = self._execution.elapsed_s + time_s - self._time_s
        if self._time_s == -inf:
            return QueriedState("there is no trajectory yet", measured)
        if elapsed_s < -RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is before the start of the trajectory", measured)
        if elapsed_s > plan.end_s + RESOLUTION_S:
            return QueriedState(f"{time_s:f} s is after the end of the trajectory", measured)
        return QueriedState("", plan.sample(max(elapsed_s, 0.0))[:MOTION_ROWS])

    def _measure(self) -> None:
        self._state.feedback[:] = self.states.read()[self._configuration.wiring.state_index]

    def _measured(self) -> NDArray[np.float64]:
        feedback = self._state.feedback
        motion = np.full((ROWS, feedback.shape[1]), np.nan)
        motion[: len(feedback)] = feedback
        return motion

    def _compute_error(self) -> NDArray[np.float64]:
        """Fill in the errors, and return the rows that count."""
        state, model = self._state, self._configuration.model
        error = state.error[: self._configuration.wiring.checked_rows]
        rows = len(error)
        np.subtract(state.reference[:rows], state.feedback[:rows], out=error)
        if model.any_continuous:
            way = shortest_way(state.feedback[POSITION], state.reference[POSITION])
            error[POSITION] = np.where(model.continuous, way, error[POSITION])
        return error

    def _refresh_speed_scaling(self) -> None:
        # What is in force now counts for the period that begins: the command for its end, and
        # the time that has passed there, agree even in the cycle in which the factor changes.
        scaling = self._speed_scaling
        scaling.refresh(float(self.states.read()[-1]) if scaling.state_names else None)
        self._state.speed_scaling = scaling.factor

    def _command(self, period_s: float) -> None:
        state, execution = self._state, self._execution
        self._commanded = execution.plan.sample(
            execution.elapsed_after(period_s, state.speed_scaling)
        )
        self._commander.command(state, self._commanded, period_s, self._speed_scaling.requested)

    def _give_feedback(self, period_s: float) -> None:
        if self._goal is None or self.sink is None:
            return
        self._feedback_wait_s -= period_s
        if self._feedback_wait_s > RESOLUTION_S:
            return
        interval_s = 1.0 / self._configuration.parameters.action_monitor_rate
        self._feedback_wait_s = max(self._feedback_wait_s + interval_s, 0.0)
        state = self._state
        self.sink.publish_feedback(
            self._goal.id,
            Feedback(
                state.time_s, state.reference.copy(), state.feedback.copy(), state.error.copy()
            ),
        )

    # Motions and goals: loop thread

    def _conclude(self, verdict: Verdict, error: NDArray[np.float64]) -> None:
        """Draw the consequences of a verdict."""
        execution = self._execution
        bounds = execution.tolerances
        late_s = execution.late_s
        match verdict:
            case Verdict.OFF_THE_PATH:
                self._give_up(PATH_TOLERANCE_VIOLATED, "state tolerance violation", bounds.path, error)
            case Verdict.TOO_LATE:
                self._give_up(too_late(late_s), "Exceeded", bounds.goal, error)
            case Verdict.AT_THE_GOAL if execution.goal is not None:
                self._end_goal(GOAL_REACHED)
                execution.settle()
