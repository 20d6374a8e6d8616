"""Converts the planning scene, its objects and its octomap from and to messages.

From messages come changes of a scene; to messages it goes whole, or in the parts that a client asks
for.
"""

from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from geometry_msgs.msg import TransformStamped
from moveit_msgs.msg import (
    AllowedCollisionEntry,
    AllowedCollisionMatrix,
    AttachedCollisionObject,
    LinkPadding,
    LinkScale,
    ObjectColor,
    PlanningSceneComponents,
    RobotState,
)
from moveit_msgs.msg import CollisionObject as ObjectMessage
from moveit_msgs.msg import PlanningScene as SceneMessage
from octomap_msgs.msg import OctomapWithPose
from shape_msgs.msg import Mesh, Plane, SolidPrimitive

from arm_node.names import listing
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidObjectError, InvalidRequestError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import (
    Warn,
    joint_positions,
    pose_message,
    pose_of,
    robot_state_message,
    transform_of,
)
from arm_planning.ros.convert_shapes import placed_shapes, solid_message
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.attached_changes import AttachedChange
from arm_planning.scene.object_changes import ObjectChange, Operation, explicit_pose
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.octree import decoded, encoded, refused
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import FixedTransform, OctomapChange, SceneChange

OPERATIONS = {
    ObjectMessage.ADD: Operation.ADD,
    ObjectMessage.REMOVE: Operation.REMOVE,
    ObjectMessage.APPEND: Operation.APPEND,
    ObjectMessage.MOVE: Operation.MOVE,
}
"""The operations by the bytes of the message."""
OCTREE = "OcTree"
EVERYTHING = 0xFFFFFFFF
Parts = PlanningSceneComponents


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
        raise InvalidObjectError(
            f"{owner} has the operation {message.operation!r}; there are ADD, REMOVE, APPEND and "
            "MOVE"
        )
    names, poses = list(message.subframe_names), list(message.subframe_poses)
    if len(names) != len(poses):
        raise InvalidObjectError(
            f"{owner} has {len(names)} names and {len(poses)} poses of subframes"
        )
    moves = operation is Operation.MOVE
    every = (message.primitive_poses, message.mesh_poses, message.plane_poses)
    return ObjectChange(
        operation,
        message.id,
        message.header.frame_id,
        pose_of(message.pose, owner),
        () if moves else _shapes(owner, message),
        {name: pose_of(pose, owner) for name, pose in zip(names, poses, strict=True)},
        (message.type.key, message.type.db),
        tuple(pose_of(pose, owner) for poses in every for pose in poses) if moves else (),
    )


def attached_change_of(message: AttachedCollisionObject) -> AttachedChange:
    """Return what a message does with an object on the robot.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: it cannot be used.
    """
    return AttachedChange(
        object_change_of(message.object), message.link_name, tuple(message.touch_links)
    )


def octomap_change_of(message: OctomapWithPose) -> OctomapChange | None:
    """Return the change that a message stands for; None if it says nothing of an octomap.

    Raises:
        PlanningError: its data are not an octree of the kind "OcTree", or it has no resolution.
    """
    octomap = message.octomap
    data = bytes(octomap.data)
    if not octomap.id:
        return None
    frame = message.header.frame_id or octomap.header.frame_id
    pose = pose_of(message.origin, "the octomap")
    if not data:
        return OctomapChange(frame, pose, octomap.resolution, None)
    if octomap.id != OCTREE:
        raise refused(f"it is of the kind '{octomap.id}', and '{OCTREE}' is read")
    return OctomapChange(frame, pose, octomap.resolution, decoded(data, binary=octomap.binary))


def _allowed(message: AllowedCollisionMatrix) -> AllowedCollisions | None:
    """Return the matrix; None if the message has none."""
    names: Sequence[str] = list(message.entry_names)
    defaults = list(message.default_entry_names), list(message.default_entry_values)
    if not names and not defaults[0]:
        return None
    rows = [list(row.enabled) for row in message.entry_values]
    if len(rows) != len(names) or any(len(row) != len(names) for row in rows):
        raise InvalidRequestError(
            f"the allowed collision matrix has {len(names)} names ({listing(names)}) but its "
            "rows are not as many and as long"
        )
    if len(defaults[0]) != len(defaults[1]):
        raise InvalidRequestError(
            f"the allowed collision matrix has {len(defaults[0])} names and {len(defaults[1])} "
            "values of defaults"
        )
    pairs = {
        (min(row, column), max(row, column)): rows[i][j]
        for i, row in enumerate(names)
        for j, column in enumerate(names)
        if i < j
    }
    return AllowedCollisions(pairs, dict(zip(*defaults, strict=True)))


def frames_in(message: SceneMessage) -> Iterator[str]:
    """Yield the frames that a scene message names."""
    objects: Iterable[Any] = [
        *message.world.collision_objects,
        *(each.object for each in message.robot_state.attached_collision_objects),
    ]
    yield from (each.header.frame_id for each in objects)
    yield from (each.header.frame_id for each in message.fixed_frame_transforms)
    yield message.world.octomap.header.frame_id


def scene_message(model: PlanningModel, scene: PlanningScene, parts: int = 0) -> SceneMessage:
    """Return a scene as a message; `parts` are bits of PlanningSceneComponents, 0 for all."""
    wanted = parts or EVERYTHING
    message = SceneMessage(is_diff=False, robot_model_name=model.robot.name)
    if wanted & Parts.SCENE_SETTINGS:
        message.name = scene.name
    if wanted & (Parts.ROBOT_STATE | Parts.ROBOT_STATE_ATTACHED_OBJECTS):
        message.robot_state = robot_state_message(model, scene.positions)
    if wanted & Parts.ROBOT_STATE_ATTACHED_OBJECTS:
        bodies = [attached_message(body) for body in scene.attached.values()]
        message.robot_state.attached_collision_objects = bodies
    if wanted & Parts.WORLD_OBJECT_GEOMETRY:
        objects = [object_message(each, model.frame) for each in scene.objects.values()]
        message.world.collision_objects = objects
    elif wanted & Parts.WORLD_OBJECT_NAMES:
        message.world.collision_objects = [ObjectMessage(id=name) for name in scene.objects]
    if wanted & Parts.OCTOMAP and scene.octomap is not None:
        message.world.octomap = octomap_message(scene.octomap, model.frame)
    if wanted & Parts.TRANSFORMS:
        message.fixed_frame_transforms = [
            _transform_message(model.frame, name, pose) for name, pose in scene.transforms.items()
        ]
    if wanted & Parts.ALLOWED_COLLISION_MATRIX:
        message.allowed_collision_matrix = matrix_message(scene.allowed)
    if wanted & Parts.LINK_PADDING_AND_SCALING:
        message.link_padding, message.link_scale = _padding(model, scene)
    if wanted & Parts.OBJECT_COLORS:
        message.object_colors = colour_messages(scene.colors)
    return message


def object_message(each: CollisionObject, frame: str) -> ObjectMessage:
    """Return an object as a message that adds it; its pose is in `frame`."""
    pose = pose_message(explicit_pose(each))
    message = ObjectMessage(id=each.id, pose=pose, operation=ObjectMessage.ADD)
    message.header.frame_id = frame
    message.type.db, message.type.key = each.type[1], each.type[0]
    message.subframe_names = list(each.subframes)
    message.subframe_poses = [pose_message(pose) for pose in each.subframes.values()]
    solids = [(solid_message(placed.shape), pose_message(placed.pose)) for placed in each.shapes]
    for shapes, poses, kind in (
        ("primitives", "primitive_poses", SolidPrimitive),
        ("meshes", "mesh_poses", Mesh),
        ("planes", "plane_poses", Plane),
    ):
        mine = [(solid, pose) for solid, pose in solids if isinstance(solid, kind)]
        setattr(message, shapes, [solid for solid, _ in mine])
        setattr(message, poses, [pose for _, pose in mine])
    return message


def attached_message(body: AttachedBody) -> AttachedCollisionObject:
    """Return an attached object as a message that attaches it."""
    return AttachedCollisionObject(
        link_name=body.link,
        object=object_message(body.object, body.link),
        touch_links=sorted(body.touch_links),
    )


def octomap_message(octomap: OccupancyMap, frame: str) -> OctomapWithPose:
    """Return an octomap as a message in the planning frame."""
    message = OctomapWithPose()
    message.header.frame_id = message.octomap.header.frame_id = frame
    message.octomap.id = OCTREE
    message.octomap.binary = True
    message.origin = pose_message(octomap.pose)
    message.octomap.resolution = octomap.resolution_m
    message.octomap.data = array("b", encoded(octomap.cubes))
    return message


def matrix_message(allowed: AllowedCollisions) -> AllowedCollisionMatrix:
    """Return the matrix: a row and a column for each name that has a pair.

    The message has no gaps, so a pair without an entry is written as what it means: its defaults.
    """
    names = sorted({name for pair in allowed.pairs for name in pair})
    rows = [
        AllowedCollisionEntry(enabled=[allowed.may_touch(row, column) for column in names])
        for row in names
    ]
    return AllowedCollisionMatrix(
        entry_names=names,
        entry_values=rows,
        default_entry_names=list(allowed.defaults),
        default_entry_values=list(allowed.defaults.values()),
    )


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


def colour_messages(colours: Mapping[str, tuple[float, float, float, float]]) -> list[ObjectColor]:
    """Return the colours of objects as messages."""
    messages: list[ObjectColor] = []
    for name, (red, green, blue, alpha) in colours.items():
        message = ObjectColor(id=name)
        message.color.r, message.color.g, message.color.b, message.color.a = red, green, blue, alpha
        messages.append(message)
    return messages


def _padding(
    model: PlanningModel, scene: PlanningScene
) -> tuple[list[LinkPadding], list[LinkScale]]:
    links = [link.name for link in model.robot.links if link.collisions]
    paddings = [
        LinkPadding(link_name=link, padding=float(scene.padding.get(link, 0.0))) for link in links
    ]
    scales = [LinkScale(link_name=link, scale=float(scene.scale.get(link, 1.0))) for link in links]
    return paddings, scales


def _transform_message(frame: str, name: str, pose: RigidTransform) -> TransformStamped:
    message = TransformStamped(child_frame_id=name)
    message.header.frame_id = frame
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = pose.position
    rotation.x, rotation.y, rotation.z, rotation.w = pose.rotation
    return message
