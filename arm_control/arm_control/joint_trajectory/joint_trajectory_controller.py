"""joint_trajectory_controller/JointTrajectoryController: follows trajectories of the joints."""

from collections.abc import Callable
from functools import partial
from math import inf, isfinite
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from arm_control.controller import Controller, ControllerContext, ReturnType
from arm_control.errors import ControllerError, ParameterError
from arm_control.interface_configuration import InterfaceConfiguration
from arm_control.joint_trajectory.angles import shortest_way
from arm_control.joint_trajectory.configuration import Configuration
from arm_control.joint_trajectory.execution import Execution, Verdict
from arm_control.joint_trajectory.inbox import GoalCancel, GoalStart, Inbox, Replacement
from arm_control.joint_trajectory.motion import (
    EFFORT,
    POSITION,
    RESOLUTION_S,
    ROWS,
    VELOCITY,
    at_rest,
)
from arm_control.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.joint_trajectory.pid import Pid
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

    def __init__(self, context: ControllerContext) -> None:
        """Read the robot description.

        Raises:
            ControllerError: it cannot be read.
        """
        super().__init__(context)
        self.sink: TrajectorySink | None = None
        self._robot = _read_robot(context)
        self._inbox = Inbox()
        self._goal: GoalRequest | None = None
        self._next: Callable[[], Execution] | None = None
        self._time_s = -inf
        self._feedback_wait_s = 0.0

    # Any thread

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
            it has a fault or the controller is not running: the sink will not.
        """
        prepared = self._prepare(goal.trajectory)
        if isinstance(prepared, Refusal):
            return prepared.as_result()
        if not self._inbox.put(GoalStart(goal, prepared)):
            return NOT_RUNNING.as_result()
        return None

    def cancel_goal(self, goal_id: object) -> None:
        """End a goal, and stop; nothing happens where it has ended already."""
        self._inbox.put(GoalCancel(goal_id))

    def submit_trajectory(self, trajectory: TrajectoryRequest) -> Refusal | None:
        """Follow a trajectory without a goal; dropped in silence while not running.

        Returns:
            Why it is not followed; it is in the log, too.
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
