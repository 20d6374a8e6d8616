"""Converts changes of the planning scene from messages."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from geometry_msgs.msg import Pose
from moveit_msgs.msg import AllowedCollisionMatrix, AttachedCollisionObject, RobotState
from moveit_msgs.msg import CollisionObject as ObjectMessage
from moveit_msgs.msg import PlanningScene as SceneMessage

from arm_node.names import listing
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import Warn, joint_positions, pose_of, transform_of
from arm_planning.ros.convert_octomap import octomap_change_of
from arm_planning.ros.convert_shapes import placed_shapes
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.attached_changes import AttachedChange
from arm_planning.scene.object_changes import ObjectChange, Operation
from arm_planning.scene.object_checks import refusal
from arm_planning.scene.scene_changes import FixedTransform, SceneChange

OPERATIONS = {
    ObjectMessage.ADD: Operation.ADD,
    ObjectMessage.REMOVE: Operation.REMOVE,
    ObjectMessage.APPEND: Operation.APPEND,
    ObjectMessage.MOVE: Operation.MOVE,
}
"""The operations by the bytes of the message."""


def scene_change_of(model: PlanningModel, message: SceneMessage, warn: Warn) -> SceneChange:
    """Return the change that a scene message stands for.

    Raises:
        PlanningError: a number or a list of it cannot be used.
    """
    state = message.robot_state
    return SceneChange(
        is_diff=message.is_diff,
        name=message.name,
        robot_name=message.robot_model_name,
        is_state_diff=state.is_diff,
        positions=joint_positions(model, state, warn),
        attached=tuple(map(attached_change_of, state.attached_collision_objects)),
        objects=tuple(map(object_change_of, message.world.collision_objects)),
        transforms={
            each.child_frame_id: FixedTransform(
                each.header.frame_id, transform_of(each.transform, each.child_frame_id)
            )
            for each in message.fixed_frame_transforms
        },
        allowed=_allowed(message.allowed_collision_matrix),
        padding={each.link_name: each.padding for each in message.link_padding},
        scale={each.link_name: each.scale for each in message.link_scale},
        colors={
            each.id: (each.color.r, each.color.g, each.color.b, each.color.a)
            for each in message.object_colors
        },
        octomap=octomap_change_of(message.world.octomap),
    )


def state_change_of(model: PlanningModel, message: RobotState, warn: Warn) -> SceneChange:
    """Return the change that a robot state stands for, as the start of a plan has one."""
    return SceneChange(
        is_state_diff=message.is_diff,
        positions=joint_positions(model, message, warn),
        attached=tuple(map(attached_change_of, message.attached_collision_objects)),
    )


def object_change_of(message: ObjectMessage) -> ObjectChange:
    """Return what a message does with an object in the world.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: it cannot be used.
    """
    owner = f"object '{message.id}'"
    operation = OPERATIONS.get(message.operation)
    if operation is None:
        raise refusal(
            f"{owner} has the operation {message.operation!r}; there are ADD, REMOVE, APPEND and "
            "MOVE"
        )
    names, poses = list(message.subframe_names), list(message.subframe_poses)
    if len(names) != len(poses):
        raise refusal(f"{owner} has {len(names)} names and {len(poses)} poses of subframes")
    moves = operation is Operation.MOVE
    every = (message.primitive_poses, message.mesh_poses, message.plane_poses)
    return ObjectChange(
        operation,
        message.id,
        message.header.frame_id,
        pose_of(message.pose, owner),
        () if moves else _shapes(owner, message),
        {name: _pose(owner, pose) for name, pose in zip(names, poses, strict=True)},
        (message.type.key, message.type.db),
        tuple(_pose(owner, pose) for poses in every for pose in poses) if moves else (),
    )


def attached_change_of(message: AttachedCollisionObject) -> AttachedChange:
    """Return what a message does with an object on the robot.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: it cannot be used.
    """
    return AttachedChange(
        object_change_of(message.object), message.link_name, tuple(message.touch_links)
    )


def frames_in(message: SceneMessage) -> Iterator[str]:
    """Yield the frames that a scene message names."""
    objects: Iterable[Any] = [
        *message.world.collision_objects,
        *(each.object for each in message.robot_state.attached_collision_objects),
    ]
    yield from (each.header.frame_id for each in objects)
    yield from (each.header.frame_id for each in message.fixed_frame_transforms)
    yield message.world.octomap.header.frame_id


def _shapes(owner: str, message: ObjectMessage) -> Any:
    return placed_shapes(
        owner,
        message.primitives,
        message.primitive_poses,
        message.meshes,
        message.mesh_poses,
        message.planes,
        message.plane_poses,
    )


def _pose(owner: str, pose: Pose) -> Any:
    return pose_of(pose, owner)


def _allowed(message: AllowedCollisionMatrix) -> AllowedCollisions | None:
    """Return the matrix; None if the message has none."""
    names: Sequence[str] = list(message.entry_names)
    defaults = list(message.default_entry_names), list(message.default_entry_values)
    if not names and not defaults[0]:
        return None
    rows = [list(row.enabled) for row in message.entry_values]
    if len(rows) != len(names) or any(len(row) != len(names) for row in rows):
        raise PlanningError(
            MoveItErrorCode.FAILURE,
            f"the allowed collision matrix has {len(names)} names ({listing(names)}) but its "
            "rows are not as many and as long",
        )
    if len(defaults[0]) != len(defaults[1]):
        raise PlanningError(
            MoveItErrorCode.FAILURE,
            f"the allowed collision matrix has {len(defaults[0])} names and {len(defaults[1])} "
            "values of defaults",
        )
    pairs = {
        (min(row, column), max(row, column)): rows[i][j]
        for i, row in enumerate(names)
        for j, column in enumerate(names)
        if i < j
    }
    return AllowedCollisions(pairs, dict(zip(*defaults, strict=True)))
