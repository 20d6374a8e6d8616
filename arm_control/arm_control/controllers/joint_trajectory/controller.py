"""joint_trajectory_controller/JointTrajectoryController: what clients and the manager use."""

from math import inf
from typing import Any, ClassVar

import numpy as np

from arm_control.controllers.controller import (
    ControllerContext,
    InterfaceConfiguration,
    ReturnType,
)
from arm_control.controllers.goals import GoalController
from arm_control.controllers.joint_trajectory.commands import SpeedScaling
from arm_control.controllers.joint_trajectory.configuration import Configuration
from arm_control.controllers.joint_trajectory.goals import (
    RESET,
    GoalCancel,
    GoalRefusal,
    GoalRequest,
    GoalResult,
    GoalStart,
    Inbox,
    TrajectoryReplacement,
    deactivated,
    not_running,
)
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.controllers.joint_trajectory.profiles import POSITION
from arm_control.controllers.joint_trajectory.state import (
    MOTION_ROWS,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
from arm_control.controllers.joint_trajectory.tracking import TrajectoryTracker
from arm_control.controllers.joint_trajectory.trajectory import (
    Interpolation,
    Trajectory,
    TrajectoryRequest,
)
from arm_control.controllers.joint_trajectory.validation import find_fault
from arm_control.errors import ControllerError, ParameterError
from arm_control.run_inputs import run_input
from arm_description.errors import DescriptionError
from arm_description.urdf.robot import Robot


class JointTrajectoryController(GoalController[JointTrajectoryParameters]):
    """Executes trajectories from action goals or a topic; otherwise it holds the position.

    Requests may arrive on any thread. They take effect at the next update, or when `serve_requests`
    is called on the loop thread, which cancels and preempts goals even while the simulation is
    paused.

    Attributes:
        sink: receives states, feedback and results; None drops them. Set it before activation.
    """

    parameters_type: ClassVar[type[Any]] = JointTrajectoryParameters
    adapter = "arm_control.controllers.joint_trajectory.ros:JointTrajectoryAdapter"

    def __init__(self, context: ControllerContext) -> None:
        """Read the robot description.

        Raises:
            ControllerError: it cannot be read.
        """
        super().__init__(context)
        self.sink: TrajectorySink | None = None
        self._robot = _read_robot(context)
        self._inbox = Inbox()
        self._configuration: Configuration | None = None
        self._speed_scaling: SpeedScaling | None = None
        self._tracker: TrajectoryTracker | None = None
        # Caches the trajectory between the check and the submission of a goal.
        self._prepared: tuple[tuple[object, ...], Trajectory | None] = ((), None)

    # Requests: any thread, once configured

    def check_goal(self, trajectory: TrajectoryRequest) -> GoalRefusal | None:
        """Return why a goal with this trajectory must be rejected, or None."""
        prepared = self._prepare(trajectory)
        if isinstance(prepared, GoalRefusal):
            self.logger.error("%s", prepared.message)
            return prepared
        return None

    @run_input
    def submit_goal(self, goal: GoalRequest) -> GoalResult | None:
        """Start an accepted goal; it replaces the previous one.

        Returns:
            None if the sink will receive the result; the result itself if the goal has already
            ended, because it is invalid or the controller is not running.
        """
        prepared = self._prepare(goal.trajectory)
        if isinstance(prepared, GoalRefusal):
            return prepared.as_result()
        tracker = self._tracker  # Read once: the loop thread may reset it.
        violations = tracker and tracker.velocity_violations(prepared)
        if violations:
            self.logger.warning("Goal too fast: %s", violations)
        self._prepared = ((), None)
        taken = self._inbox.put(GoalStart(goal, prepared))
        return None if taken else not_running(self.halted_by).as_result()

    @run_input
    def cancel_goal(self, goal_id: object) -> None:
        """Cancel a goal and stop; has no effect if it has already ended."""
        self._inbox.put(GoalCancel(goal_id))

    @run_input
    def submit_trajectory(self, trajectory: TrajectoryRequest) -> GoalRefusal | None:
        """Execute a trajectory without a goal; ignore it while the controller is not active.

        Returns:
            Why it was refused, which is also logged; None if it was accepted.
        """
        if not self._inbox.is_open:
            return None
        prepared = self._prepare(trajectory)
        if isinstance(prepared, GoalRefusal):
            self.logger.error("%s", prepared.message)
            return prepared
        self._inbox.put(TrajectoryReplacement(prepared))
        return None

    @property
    def state_layout(self) -> StateLayout:
        """The layout with which the sink will be opened, for sinks that prepare earlier."""
        return StateLayout.of(self._configured()[0].interfaces)

    @property
    def takes_speed_scaling(self) -> bool:
        """Whether clients may scale the speed: only if positions alone are commanded."""
        configuration = self._configuration
        return configuration is not None and configuration.interfaces.command_rows == (POSITION,)

    @run_input
    def request_speed_scaling(self, factor: float) -> bool:
        """Set the speed of trajectory time; return whether that is possible."""
        return self._speed_scaling is not None and self._speed_scaling.request(factor)

    # Loop thread

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim each interface of each command joint."""
        configuration, scaling = self._configured()
        return InterfaceConfiguration.individual(
            configuration.interfaces.command_names + scaling.command_names
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read each interface of each joint."""
        configuration, scaling = self._configured()
        return InterfaceConfiguration.individual(
            configuration.interfaces.state_names + scaling.state_names
        )

    def on_configure(self, parameters: JointTrajectoryParameters) -> None:
        """Take the parameters.

        Raises:
            ControllerError: they cannot be used.
        """
        if parameters.open_loop_control:
            self.logger.warning(
                "parameter 'open_loop_control' is deprecated: use 'interpolate_from_desired_state'"
            )
        try:
            self._configuration = Configuration.of(parameters, self._robot, self.logger)
        except ParameterError as error:
            raise ControllerError(str(error)) from error
        self._speed_scaling = SpeedScaling(parameters.speed_scaling, self.logger)
        super().on_configure(parameters)

    def update_parameters(self, parameters: JointTrajectoryParameters) -> None:
        """Apply parameters that changed since `on_configure`; read-only ones are unchanged.

        Raises:
            ControllerError: they do not match; the old ones stay.
            ParameterError: one is out of its range; the old ones stay.
        """
        self._configuration = Configuration.of(parameters, self._robot, self.logger)
        if self._tracker is not None:
            self._tracker.reconfigure(self._configuration)
        super().update_parameters(parameters)

    def on_activate(self) -> None:
        """Hold the position and start accepting requests."""
        configuration, scaling = self._configured()
        self._tracker = TrajectoryTracker(
            configuration, self.commands, self.states, scaling, self.sink, self.logger
        )
        self._inbox.open()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Run one cycle."""
        if self._tracker is not None:
            self._serve_requests()
            self._tracker.update(time_s, period_s)
        return ReturnType.OK

    @run_input
    def serve_requests(self) -> None:
        """Process the clients' requests; a motion starts at the next update."""
        self._serve_requests()

    def _serve_requests(self) -> None:
        if self._inbox and self._tracker is not None:
            self._tracker.serve(self._inbox.take())

    def save_state(self) -> Any:
        """Return the motion and its goal; pending requests are served first."""
        self._serve_requests()
        tracker, scaling = self._tracker, self._speed_scaling
        return (
            None if scaling is None else scaling.save_state(),
            None if tracker is None else tracker.save_state(),
        )

    def load_state(self, state: Any) -> None:
        """Continue with a saved motion; a running goal that it lacks is aborted."""
        self._serve_requests()
        scaling, tracker = state
        if self._speed_scaling is not None and scaling is not None:
            self._speed_scaling.load_state(scaling)
        if self._tracker is not None and tracker is not None:
            self._tracker.load_state(tracker)

    def fingerprint(self) -> bytes:
        """Return the numbers of the motion."""
        return b"" if self._tracker is None else self._tracker.fingerprint()

    def on_reset(self) -> None:
        """Abort the goal and hold the present position."""
        if self._tracker is not None:
            self._tracker.abort(self._inbox.take(), RESET)
            self.on_activate()

    def query_state(self, time_s: float) -> QueriedState:
        """Return the set-point of the current trajectory at a time of the controller's clock."""
        if self._tracker is None:
            return QueriedState("the controller is not active", np.empty((MOTION_ROWS, 0)))
        return self._tracker.query(time_s)

    def on_deactivate(self) -> None:
        """Abort the goal; position commands stay, all others become 0."""
        tracker, self._tracker = self._tracker, None
        unserved = self._inbox.close()
        if tracker is not None:
            tracker.abort(unserved, deactivated(self.halted_by))
            tracker.write_safe_commands()

    def on_cleanup(self) -> None:
        """Forget the parameters."""
        self._configuration = self._speed_scaling = None
        super().on_cleanup()

    def _configured(self) -> tuple[Configuration, SpeedScaling]:
        if self._configuration is None or self._speed_scaling is None:
            raise ControllerError(f"controller '{self.name}' is not configured")
        return self._configuration, self._speed_scaling

    def _prepare(self, request: TrajectoryRequest) -> Trajectory | GoalRefusal:
        """Return the trajectory of a request, or why it is refused.

        Before the first update the time is unknown; then the checks of a stamp are left to that
        update.
        """
        tracker, configuration = self._tracker, self._configuration
        if tracker is None or configuration is None:
            return not_running(self.halted_by)
        now_s = tracker.time_s
        parameters = configuration.parameters
        fault = find_fault(request, parameters, -inf if now_s is None else now_s)
        if fault is not None:
            return fault
        is_provisional = now_s is None and request.stamp_s != 0.0
        basis = (request, configuration, is_provisional)
        known, trajectory = self._prepared
        if trajectory is None or any(a is not b for a, b in zip(known, basis, strict=True)):
            trajectory = Trajectory(
                request,
                parameters.joints,
                Interpolation(parameters.interpolation_method),
                is_provisional=is_provisional,
            )
            self._prepared = (basis, trajectory)
        excess = None if trajectory.is_provisional else tracker.limit_violations(trajectory)
        return excess or trajectory


def _read_robot(context: ControllerContext) -> Robot | None:
    try:
        return context.read_robot()
    except DescriptionError as error:
        raise ControllerError(f"the robot description cannot be used: {error}") from error
