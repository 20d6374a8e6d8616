"""Goals as messages: joint positions, or the pose of a link, as MoveIt's clients write them."""

from collections.abc import Mapping

from geometry_msgs.msg import Pose
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import (
    Constraints,
    JointConstraint,
    MotionPlanRequest,
    OrientationConstraint,
    PositionConstraint,
)
from shape_msgs.msg import SolidPrimitive

from arm_node.rigid_transform import Quaternion, RigidTransform, Vector
from arm_planning.constraints.constraints import (
    JOINT_TOLERANCE,
    ORIENTATION_TOLERANCE,
    POSITION_TOLERANCE_M,
)
from arm_planning.ros.convert import pose_message


def plan_message(group: str, goal: Constraints, **fields: float | int | str) -> MotionPlanRequest:
    """Return a request to move a group to a goal; `fields` are further fields of the message."""
    request = MotionPlanRequest(group_name=group, goal_constraints=[goal], **fields)
    request.start_state.is_diff = True
    return request


def move_goal(request: MotionPlanRequest, *, plan_only: bool) -> MoveGroup.Goal:
    """Return the goal of move_action: a request in the present scene."""
    goal = MoveGroup.Goal(request=request)
    options = goal.planning_options
    options.plan_only = plan_only
    options.planning_scene_diff.is_diff = options.planning_scene_diff.robot_state.is_diff = True
    return goal


def joint_goal(positions: Mapping[str, float]) -> Constraints:
    """Return the goal that joints are at positions, rad or m."""
    return Constraints(
        joint_constraints=[
            JointConstraint(
                joint_name=joint,
                position=position,
                tolerance_above=JOINT_TOLERANCE,
                tolerance_below=JOINT_TOLERANCE,
                weight=1.0,
            )
            for joint, position in positions.items()
        ]
    )


def pose_goal(
    link: str, position: Vector, orientation: Quaternion | None = None, frame: str = ""
) -> Constraints:
    """Return the goal that a link is at a position, and in an orientation if one is given."""
    goal = Constraints(position_constraints=[_position(link, position, frame)])
    if orientation is not None:
        wanted = OrientationConstraint(
            link_name=link,
            parameterization=OrientationConstraint.ROTATION_VECTOR,
            absolute_x_axis_tolerance=ORIENTATION_TOLERANCE,
            absolute_y_axis_tolerance=ORIENTATION_TOLERANCE,
            absolute_z_axis_tolerance=ORIENTATION_TOLERANCE,
            weight=1.0,
        )
        wanted.header.frame_id = frame
        wanted.orientation = pose_message(RigidTransform(rotation=orientation)).orientation
        goal.orientation_constraints = [wanted]
    return goal


def _position(link: str, position: Vector, frame: str) -> PositionConstraint:
    message = PositionConstraint(link_name=link, weight=1.0)
    message.header.frame_id = frame
    sphere = SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[POSITION_TOLERANCE_M])
    centre: Pose = pose_message(RigidTransform(position))
    message.constraint_region.primitives = [sphere]
    message.constraint_region.primitive_poses = [centre]
    return message
