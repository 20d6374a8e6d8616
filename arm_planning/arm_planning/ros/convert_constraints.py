"""Converts constraints and planning requests from messages, with their frames resolved."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from moveit_msgs.msg import Constraints as ConstraintsMessage
from moveit_msgs.msg import JointConstraint as JointMessage
from moveit_msgs.msg import MotionPlanRequest
from moveit_msgs.msg import OrientationConstraint as OrientationMessage
from moveit_msgs.msg import PositionConstraint as PositionMessage

from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform, quaternion_product
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    OrientationError,
    PositionConstraint,
)
from arm_planning.errors import InvalidGoalError, InvalidLinkError, PlanningError
from arm_planning.request import PlanRequest
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import Warn, quaternion_of, vector_of
from arm_planning.ros.convert_shapes import placed_shapes
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.scene import PlanningScene

DEFAULT_TIME_S = 1.0
"""MoveIt's time for a request that gives none."""


@dataclass(frozen=True, slots=True)
class ConstraintFrames:
    """Finds the frames that constraints name.

    Attributes:
        model: the robot.
        scene: the scene with its objects.
        pose: returns a fixed frame's pose in the planning frame; raises PlanningError if it does
            not exist.
    """

    model: PlanningModel
    scene: PlanningScene
    pose: Callable[[str], RigidTransform]

    def link_and_offset(self, name: str) -> tuple[str, RigidTransform]:
        """Return the link that a link, an attached object or one of its subframes moves with.

        Raises:
            PlanningError: INVALID_LINK_NAME: there is none of that name.
        """
        if any(link.name == name for link in self.model.robot.links):
            return name, RigidTransform()
        owner, _, subframe = name.partition("/")
        body = self.scene.attached.get(name) or self.scene.attached.get(owner)
        if body is not None:
            if name == body.object.id:
                return body.link, body.object.pose
            if subframe in body.object.subframes:
                return body.link, body.object.pose.then(body.object.subframes[subframe])
        links = [link.name for link in self.model.robot.links]
        known = describe_known(name, [*links, *self.scene.attached], "the robot has")
        raise InvalidLinkError(f"no link '{name}'; {known}")

    def reference(self, name: str) -> tuple[str, RigidTransform]:
        """Return the link that a frame moves with ("": the planning frame) and its pose there.

        Raises:
            PlanningError: FRAME_TRANSFORM_FAILURE: there is no such frame.
        """
        name = name.lstrip("/")
        if name in ("", self.model.frame, self.model.robot.root):
            return "", RigidTransform()
        try:
            return self.link_and_offset(name)
        except PlanningError:
            return "", self.pose(name)

    def placed(self, link: str, offset: RigidTransform) -> RigidTransform:
        """Return the pose in the planning frame of what has a pose on a link, or on "": in it.

        Raises:
            PlanningError: INVALID_LINK_NAME: there is no such link.
        """
        return LinkPoses(self.model, self.scene.positions).of(link).then(offset) if link else offset


def constraints_of(
    message: ConstraintsMessage, frames: ConstraintFrames, warn: Warn
) -> MotionConstraints:
    """Return constraints with frames that planning knows.

    Raises:
        PlanningError: a link, joint or frame does not exist, or a number is not usable.
    """
    if message.visibility_constraints:
        raise InvalidGoalError(
            "visibility constraints are not supported; joint, position and orientation "
            "constraints are"
        )
    return MotionConstraints(
        tuple(_joint(each, frames.model, warn) for each in message.joint_constraints),
        tuple(
            _position(each, frames, warn)
            for each in message.position_constraints
            if _has_region(each, warn)
        ),
        tuple(_orientation(each, frames, warn) for each in message.orientation_constraints),
        message.name,
    )


def plan_request(
    message: MotionPlanRequest, seed: int, frames: ConstraintFrames, warn: Warn
) -> PlanRequest:
    """Return a planning request that starts from the state of the scene that has these frames.

    `warn` takes what is passed over or replaced.

    Raises:
        PlanningError: see `constraints_of`.
    """
    time_s = message.allowed_planning_time
    if not time_s > 0.0:
        time_s = DEFAULT_TIME_S
    return PlanRequest(
        group=message.group_name,
        goals=tuple(constraints_of(each, frames, warn) for each in message.goal_constraints),
        path=constraints_of(message.path_constraints, frames, warn),
        pipeline=message.pipeline_id,
        planner=message.planner_id,
        attempts=max(message.num_planning_attempts, 1),
        allowed_time_s=time_s,
        velocity_scaling=message.max_velocity_scaling_factor,
        acceleration_scaling=message.max_acceleration_scaling_factor,
        seed=seed,
    )


def _joint(message: JointMessage, model: PlanningModel, warn: Warn) -> JointConstraint:
    names = [joint.name for joint in model.robot.movable_joints]
    if message.joint_name not in names:
        known = describe_known(message.joint_name, names, "the robot has")
        raise InvalidGoalError(f"a constraint names the joint '{message.joint_name}'; {known}")
    numbers = (message.position, message.tolerance_above, message.tolerance_below)
    if not all(map(math.isfinite, numbers)):
        raise InvalidGoalError(
            f"the constraint on joint '{message.joint_name}' is not finite: {numbers}"
        )
    if message.tolerance_above < 0.0 or message.tolerance_below < 0.0:
        raise InvalidGoalError(
            f"the constraint on joint '{message.joint_name}' has a negative tolerance"
        )
    return JointConstraint(
        message.joint_name,
        message.position,
        above=message.tolerance_above,
        below=message.tolerance_below,
        weight=_weight(message.weight, f"joint '{message.joint_name}'", warn),
    )


def _has_region(message: PositionMessage, warn: Warn) -> bool:
    region = message.constraint_region
    if region.primitives or region.meshes:
        return True
    warn(f"the position constraint on link '{message.link_name}' has no region and is ignored")
    return False


def _position(message: PositionMessage, frames: ConstraintFrames, warn: Warn) -> PositionConstraint:
    owner = f"the region of the position constraint on '{message.link_name}'"
    region = message.constraint_region
    try:
        shapes = placed_shapes(
            owner, region.primitives, region.primitive_poses, region.meshes, region.mesh_poses
        )
        what = f"the offset of '{message.link_name}'"
        point = vector_of(message.target_point_offset, what)
    except PlanningError as error:
        raise InvalidGoalError(str(error)) from error
    frame, origin = frames.reference(message.header.frame_id)
    link, offset = frames.link_and_offset(message.link_name)
    return PositionConstraint(
        link,
        offset.then(RigidTransform(point)).position,
        tuple(PlacedShape(each.shape, origin.then(each.pose)) for each in shapes),
        frame,
        _weight(message.weight, f"the position of '{message.link_name}'", warn),
    )


def _orientation(
    message: OrientationMessage, frames: ConstraintFrames, warn: Warn
) -> OrientationConstraint:
    link, offset = frames.link_and_offset(message.link_name)
    frame, origin = frames.reference(message.header.frame_id)
    what = f"the orientation constraint on '{message.link_name}'"
    try:
        given = quaternion_of(message.orientation, what)
    except PlanningError as error:
        raise InvalidGoalError(str(error)) from error
    wanted = quaternion_product(origin.rotation, given)
    tolerances = (
        message.absolute_x_axis_tolerance,
        message.absolute_y_axis_tolerance,
        message.absolute_z_axis_tolerance,
    )
    if not all(tolerance >= 0.0 for tolerance in tolerances):
        raise InvalidGoalError(f"{what} has tolerances that are not positive: {tolerances}")
    if message.parameterization not in (0, 1):
        raise InvalidGoalError(
            f"{what} has the parameterization {message.parameterization}; there are "
            "0 (XYZ_EULER_ANGLES) and 1 (ROTATION_VECTOR)"
        )
    # The link is where the object on it would be in the wanted orientation.
    return OrientationConstraint(
        link,
        quaternion_product(wanted, offset.inverse().rotation),
        tolerances,
        OrientationError(message.parameterization),
        frame,
        _weight(message.weight, what, warn),
        axes=origin.rotation,
    )


def _weight(weight: float, what: str, warn: Warn) -> float:
    if weight > 0.0:
        return weight
    warn(f"the weight of the constraint on {what} is {weight:g}; 1 is used")
    return 1.0
