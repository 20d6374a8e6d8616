"""joint_trajectory_controller/JointTrajectoryController: follows trajectories of the joints."""

from collections.abc import Mapping
from math import inf
from typing import Any, ClassVar

import numpy as np

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError, ParameterError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.joint_trajectory.configuration import Configuration
from arm_control.joint_trajectory.follower import Follower
from arm_control.joint_trajectory.inbox import GoalCancel, GoalStart, Inbox, Replacement
from arm_control.joint_trajectory.motion import POSITION
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.joint_trajectory.requests import GoalRequest, TrajectoryRequest
from arm_control.joint_trajectory.results import NOT_RUNNING, GoalResult, Refusal
from arm_control.joint_trajectory.speed_scaling import SpeedScaling
from arm_control.joint_trajectory.state import (
    MOTION_ROWS,
    QueriedState,
    StateLayout,
    TrajectorySink,
)
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
    adapter = "arm_control.ros.joint_trajectory_adapter:JointTrajectoryAdapter"

    def __init__(self, context: ControllerContext) -> None:
        """Read the robot description.

        Raises:
            ControllerError: it cannot be read.
        """
        super().__init__(context)
        self.sink: TrajectorySink | None = None
        self._robot = _read_robot(context.robot_description)
        self._inbox = Inbox()
        self._configuration: Configuration | None = None
        self._speed_scaling: SpeedScaling | None = None
        self._follower: Follower | None = None

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

    # Requests: any thread, once configured

    def check_goal(self, trajectory: TrajectoryRequest) -> Refusal | None:
        """Return why a goal with this trajectory is to be rejected, None where it is not."""
        prepared = self._prepare(trajectory)
        if isinstance(prepared, Refusal):
            self.logger.error("%s", prepared.message)
            return prepared
        return None

    def submit_goal(self, goal: GoalRequest) -> GoalResult | None:
        """Start a goal that was accepted; it takes the place of the one before.

        Returns:
            None: the sink will hear of the end. A result where the goal has ended already, because
            it has a fault or the controller is not running: the sink will not hear of it.
        """
        prepared = self._prepare(goal.trajectory)
        if isinstance(prepared, Refusal):
            return prepared.as_result()
        follower = self._follower  # which the loop thread may take away between two looks
        haste = follower and follower.find_haste(prepared)
        if haste:
            self.logger.warning("Goal too fast: %s", haste)
        taken = self._inbox.put(GoalStart(goal, prepared))
        return None if taken else NOT_RUNNING.as_result()

    def cancel_goal(self, goal_id: object) -> None:
        """End a goal, and stop; nothing happens where it has ended already."""
        self._inbox.put(GoalCancel(goal_id))

    def submit_trajectory(self, trajectory: TrajectoryRequest) -> Refusal | None:
        """Follow a trajectory without a goal; while not running it is dropped in silence.

        Returns:
            Why it is not followed; the log says so, too.
        """
        if not self._inbox.is_open:
            return None
        prepared = self._prepare(trajectory)
        if isinstance(prepared, Refusal):
            self.logger.error("%s", prepared.message)
            return prepared
        self._inbox.put(Replacement(prepared))
        return None

    @property
    def state_layout(self) -> StateLayout:
        """What the sink will be opened with, for one that needs time to get ready."""
        return StateLayout.of(self._configured()[0].wiring)

    @property
    def takes_speed_scaling(self) -> bool:
        """Whether clients may scale the speed: where nothing but positions is commanded."""
        configuration = self._configuration
        return configuration is not None and configuration.wiring.command_rows == (POSITION,)

    def request_speed_scaling(self, factor: float) -> bool:
        """Let trajectory time run at a factor; return whether that is possible."""
        return self._speed_scaling is not None and self._speed_scaling.request(factor)

    # Loop thread

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim each interface of each command joint."""
        configuration, scaling = self._configured()
        return InterfaceConfiguration.individual(
            configuration.wiring.command_names + scaling.command_names
        )

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read each interface of each joint."""
        configuration, scaling = self._configured()
        return InterfaceConfiguration.individual(
            configuration.wiring.state_names + scaling.state_names
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

    def update_parameters(self, parameters: JointTrajectoryParameters) -> None:
        """Take parameters that changed since `on_configure`; read-only ones are as before.

        Raises:
            ControllerError: they do not go together; the old ones stay.
            ParameterError: one is out of its range; the old ones stay.
        """
        self._configuration = Configuration.of(parameters, self._robot, self.logger)
        if self._follower is not None:
            self._follower.reconfigure(self._configuration)

    def on_activate(self) -> None:
        """Begin to hold still, and to take requests."""
        configuration, scaling = self._configured()
        self._follower = Follower(
            configuration, self.commands, self.states, scaling, self.sink, self.logger
        )
        self._inbox.open()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Run one cycle."""
        if self._follower is not None:
            self.serve_requests()
            self._follower.update(time_s, period_s)
        return ReturnType.OK

    def serve_requests(self) -> None:
        """Take over what clients have asked for; a motion begins at the next update."""
        if self._inbox and self._follower is not None:
            self._follower.serve(self._inbox.take())

    def query_state(self, time_s: float) -> QueriedState:
        """Return what the present trajectory wants at a time of the controller's clock."""
        if self._follower is None:
            return QueriedState("the controller is not active", np.empty((MOTION_ROWS, 0)))
        return self._follower.query(time_s)

    def on_deactivate(self) -> None:
        """Abort the goal; positions stay commanded, everything else becomes zero."""
        follower, self._follower = self._follower, None
        unserved = self._inbox.close()
        if follower is not None:
            follower.close(unserved)

    def on_cleanup(self) -> None:
        """Forget the parameters."""
        self._configuration = self._speed_scaling = None

    def _configured(self) -> tuple[Configuration, SpeedScaling]:
        if self._configuration is None or self._speed_scaling is None:
            raise ControllerError(f"controller '{self.name}' is not configured")
        return self._configuration, self._speed_scaling

    def _prepare(self, request: TrajectoryRequest) -> Trajectory | Refusal:
        """Return the trajectory of a request, or why it cannot be followed.

        Before the first update nobody knows the time; then what depends on it, which is only so
        with a stamp, is left to that update.
        """
        follower, configuration = self._follower, self._configuration
        if follower is None or configuration is None:
            return NOT_RUNNING
        now_s = follower.time_s
        fault = find_fault(request, configuration.rules, -inf if now_s is None else now_s)
        if fault is not None:
            return fault
        trajectory = Trajectory(
            request,
            configuration.rules.joints,
            configuration.interpolation,
            is_provisional=now_s is None and request.stamp_s != 0.0,
        )
        excess = None if trajectory.is_provisional else follower.find_excess(trajectory)
        return excess or trajectory


def _read_robot(robot_description: str) -> Robot | None:
    if not robot_description:
        return None
    try:
        return parse_urdf(robot_description)
    except DescriptionError as error:
        raise ControllerError(f"the robot description cannot be used: {error}") from error
