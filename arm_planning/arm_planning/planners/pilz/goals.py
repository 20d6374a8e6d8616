"""What a request asks of LIN, PTP and CIRC: start, goal and scaling, checked as Pilz does."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_node.names import listing
from arm_node.rigid_transform import RigidTransform, Vector, rotated
from arm_planning.constraints.constraints import (
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.errors import (
    InvalidGoalError,
    InvalidPlanError,
    InvalidStateError,
)
from arm_planning.kinematics.pose_target import checked_pose
from arm_planning.request import PlanRequest
from arm_planning.robot.model import JointGroup, JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses

Array = NDArray[np.float64]

SMALLEST_SCALING = 1e-4
_OUTSIDE = 1e-9
"""By how many rad or m a start may be beyond a limit."""


@dataclass(frozen=True, slots=True, eq=False)
class PilzGoal:
    """A checked request.

    Attributes:
        group: the group to move.
        start: its positions at the start, (n,).
        state: positions of all joints at the start.
        link: the link that the goal is for, or the group's tip.
        joints: goal positions, (n,), or None for a pose goal.
        pose: goal pose of the link in the planning frame, or None for a joint goal.
    """

    group: JointGroup
    start: Array
    state: JointPositions
    link: str
    joints: Array | None
    pose: RigidTransform | None


def checked_goal(model: PlanningModel, request: PlanRequest, state: JointPositions) -> PilzGoal:
    """Return what a request asks for.

    Args:
        model: the robot.
        request: the request; its start positions go before those of `state`.
        state: positions of all joints.

    Raises:
        PlanningError: with the code and the sense of Pilz' own error.
    """
    for name, value in (
        ("Velocity", request.velocity_scaling),
        ("Acceleration", request.acceleration_scaling),
    ):
        if not SMALLEST_SCALING <= value <= 1.0:
            raise InvalidPlanError(
                f"{name} scaling not in range [{SMALLEST_SCALING}, 1], actual value is: {value:g}"
            )
    group = model.group(request.group)
    state = {**state, **(request.start or {})}
    start = _checked_start(group, state)
    if len(request.goals) != 1:
        raise InvalidGoalError(
            f"Exactly one goal constraint required, but {len(request.goals)} goal constraints given"
        )
    (goal,) = request.goals
    if bool(goal.joints) == bool(goal.positions or goal.orientations):
        raise InvalidGoalError("Only cartesian XOR joint goal allowed")
    if goal.joints:
        return PilzGoal(group, start, state, group.tip, _joint_goal(group, goal, start), None)
    position, orientation = _pose_constraints(goal)
    pose = RigidTransform(
        frame_position(model, state, position), _frame_rotation(model, state, orientation)
    )
    offset = rotated(pose.rotation, position.offset)
    x, y, z = (p - o for p, o in zip(pose.position, offset, strict=True))
    return PilzGoal(
        group, start, state, position.link, None, RigidTransform((x, y, z), pose.rotation)
    )


def frame_position(
    model: PlanningModel, state: JointPositions, constraint: PositionConstraint
) -> Vector:
    """Return the point that a position constraint stands for, in the planning frame.

    Raises:
        PlanningError: INVALID_GOAL_CONSTRAINTS: it has no region.
    """
    if not constraint.regions:
        raise InvalidGoalError("Primitive pose in position constraints of goal missing")
    frame = _frame(model, state, constraint.frame)
    return _checked_transform(frame.then(constraint.regions[0].pose)).position


def _frame_rotation(
    model: PlanningModel, state: JointPositions, constraint: OrientationConstraint
) -> tuple[float, float, float, float]:
    frame = _frame(model, state, constraint.frame)
    turned = RigidTransform(rotation=constraint.orientation)
    return _checked_transform(frame.then(turned)).rotation


def _frame(model: PlanningModel, state: JointPositions, name: str) -> RigidTransform:
    return LinkPoses(model, state).of(name) if name else RigidTransform()


def _checked_transform(pose: RigidTransform) -> RigidTransform:
    (x, y, z), (w, a, b, c) = (part.tolist() for part in checked_pose(pose))
    return RigidTransform((x, y, z), (a, b, c, w))


def _checked_start(group: JointGroup, state: JointPositions) -> Array:
    missing = [joint for joint in group.joints if joint not in state]
    if missing:
        raise InvalidStateError(f"the start state lacks joints {listing(missing)}")
    start = group.positions(state)
    outside = ~((start >= group.lower - _OUTSIDE) & (start <= group.upper + _OUTSIDE))
    if outside.any():
        names = [joint for joint, is_out in zip(group.joints, outside, strict=True) if is_out]
        raise InvalidStateError(
            f"start state joints outside their position limits: {listing(names)}"
        )
    return start


def _joint_goal(group: JointGroup, goal: MotionConstraints, start: Array) -> Array:
    q = start.copy()
    for constraint in goal.joints:
        if constraint.joint not in group.joints:
            raise InvalidGoalError(
                f'Joint "{constraint.joint}" does not belong to group "{group.name}"; it has '
                f"{listing(group.joints)}"
            )
        index = group.joints.index(constraint.joint)
        limits = group.limits[index]
        if not limits.lower - _OUTSIDE <= constraint.position <= limits.upper + _OUTSIDE:
            raise InvalidGoalError(
                f'Joint "{constraint.joint}" violates joint limits in goal constraints: '
                f"{constraint.position:g} is not in [{limits.lower:g}, {limits.upper:g}]"
            )
        q[index] = constraint.position
    return q


def _pose_constraints(goal: MotionConstraints) -> tuple[PositionConstraint, OrientationConstraint]:
    if len(goal.positions) != 1 or len(goal.orientations) != 1:
        raise InvalidGoalError(
            "a pose goal has exactly one position and one orientation constraint; this one has "
            f"{len(goal.positions)} and {len(goal.orientations)}"
        )
    position, orientation = goal.positions[0], goal.orientations[0]
    if not position.link:
        raise InvalidGoalError("Link name of position constraint missing")
    if position.link != orientation.link:
        raise InvalidGoalError(
            "Position and orientation constraint name do not match (Position constraint name: "
            f'"{position.link}" | Orientation constraint name: "{orientation.link}")'
        )
    return position, orientation
