"""PTP, LIN and CIRC: the planners of the pipeline pilz_industrial_motion_planner.

They plan one certain motion and avoid nothing; what is in the way is found by the check of the
trajectory afterwards. Semantics, codes and sentences are those of Pilz, but for two: LIN and CIRC
slow down for a joint that could not follow, and messages name the place on the path.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from arm_node.names import listing
from arm_node.rigid_transform import Vector
from arm_planning.errors import (
    InvalidGoalError,
    InvalidLinkError,
    InvalidPlanError,
    MoveItErrorCode,
    NoPlanError,
    PlanningError,
)
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.planners.pilz.arc import PoseArc, arc_about, arc_through
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pilz.goals import PilzGoal, checked_goal, frame_position
from arm_planning.planners.pilz.tip_motion import PoseCurve, checked, tip_motion
from arm_planning.planners.pose_line import PoseLine
from arm_planning.request import PlanRequest
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.timing.parameterize import parameterize
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]
Free = Callable[[Array], bool]

PLANNERS = ("PTP", "LIN", "CIRC")
DEFAULT = "PTP"


class PilzPlanner:
    """Plans point-to-point motions, straight lines and arcs. For one thread at a time.

    Args:
        model: the robot.
        limits: limits of the tip; None for the defaults.
    """

    def __init__(self, model: PlanningModel, limits: CartesianLimits | None = None) -> None:
        self.model = model
        self.limits = limits or CartesianLimits()

    def plan(
        self, request: PlanRequest, state: JointPositions, free: Free | None = None
    ) -> TimedTrajectory:
        """Return the motion that a request asks for, from rest to rest.

        Args:
            request: its planner is one of `PLANNERS`, "" for PTP.
            state: positions of all joints of the model; those of the request's start go before.
            free: says whether positions of the group, (n,), are free of collisions; a pose goal of
                PTP is reached in such a state.

        Raises:
            PlanningError: with Pilz' code; the message is the reason.
        """
        name = request.planner or DEFAULT
        if name not in PLANNERS:
            raise NoPlanError(
                f"no planner '{name}' in pilz_industrial_motion_planner; "
                f"there are {listing(PLANNERS)}"
            )
        goal = checked_goal(self.model, request, state)
        if name == "PTP":
            return self._point_to_point(goal, request, free)
        if goal.joints is not None:
            self._require_all_joints(goal, request, name)
        kinematics = self.kinematics(goal.group.name, goal.link, goal.state)
        line = self._line(goal, kinematics)
        curve = line if name == "LIN" else self._arc(line, goal, request)
        return tip_motion(
            name,
            curve,
            kinematics,
            goal.start,
            self.limits,
            request.velocity_scaling,
            request.acceleration_scaling,
        )

    def kinematics(self, group: str, link: str, state: JointPositions) -> InverseKinematics:
        """Return the inverse kinematics for a link.

        Raises:
            PlanningError: NO_IK_SOLUTION: the group cannot place the link.
        """
        try:
            return InverseKinematics(self.model, group, link, state)
        except PlanningError as error:
            raise PlanningError(
                MoveItErrorCode.NO_IK_SOLUTION,
                f'No IK solver available for link: "{link}": {error}',
            ) from error

    def _point_to_point(
        self, goal: PilzGoal, request: PlanRequest, free: Free | None
    ) -> TimedTrajectory:
        joints = goal.joints
        if goal.pose is not None:
            kinematics = self.kinematics(goal.group.name, goal.link, goal.state)
            try:
                joints = kinematics.solve(
                    goal.pose, goal.start, free=free, random_seed=request.seed
                )
            except PlanningError as error:
                raise PlanningError(
                    error.code,
                    f"Failed to compute inverse kinematics for link: {goal.link} of goal pose: "
                    f"{error}",
                ) from error
        trajectory = parameterize(
            np.array([goal.start, joints]),
            goal.group.limits,
            joints=goal.group.joints,
            velocity_scaling=request.velocity_scaling,
            acceleration_scaling=request.acceleration_scaling,
        )
        return checked(
            "PTP",
            trajectory,
            goal.group.limits,
            request.velocity_scaling,
            request.acceleration_scaling,
        )

    @staticmethod
    def _require_all_joints(goal: PilzGoal, request: PlanRequest, name: str) -> None:
        given = len({constraint.joint for constraint in request.goals[0].joints})
        if given != len(goal.group.joints):
            raise InvalidGoalError(
                f"{name}: the goal has {given} joints, and group '{goal.group.name}' has "
                f"{len(goal.group.joints)}: {listing(goal.group.joints)}"
            )

    @staticmethod
    def _line(goal: PilzGoal, kinematics: InverseKinematics) -> PoseLine:
        """Return the straight line from the start to the goal."""
        end = goal.pose
        if goal.joints is not None:
            end = kinematics.tip_pose(goal.joints)
        assert end is not None
        return PoseLine(kinematics.tip_pose(goal.start), end)

    def _arc(self, line: PoseLine, goal: PilzGoal, request: PlanRequest) -> PoseCurve:
        kind, point = self._auxiliary_point(goal, request)
        make: Callable[..., PoseArc] = arc_through if kind == "interim" else arc_about
        return make(line.start, point, line.end)

    def _auxiliary_point(self, goal: PilzGoal, request: PlanRequest) -> tuple[str, Vector]:
        """Return which point of the arc the path constraints give, and where it is."""
        path = request.path
        if path.name not in ("interim", "center"):
            raise InvalidPlanError(
                'No path constraint named "interim" or "center" found (found path constraint: '
                f'"{path.name}")'
            )
        if len(path.positions) != 1:
            raise InvalidPlanError(
                "CIRC needs exactly one position constraint in its path constraints, the "
                f"{path.name} point; there are {len(path.positions)}"
            )
        (constraint,) = path.positions
        if not constraint.regions:
            raise InvalidPlanError(f"the {path.name} point of CIRC has no primitive pose")
        links = [link.name for link in self.model.robot.links]
        if constraint.link and constraint.link not in links:
            raise InvalidLinkError(
                f"no link '{constraint.link}' for the {path.name} point of CIRC; the robot has "
                f"{listing(links)}"
            )
        return path.name, frame_position(self.model, goal.state, constraint)
