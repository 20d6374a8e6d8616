"""The planning scene as messages, whole or in the parts that a client asks for."""

from collections.abc import Mapping

from geometry_msgs.msg import TransformStamped
from moveit_msgs.msg import (
    AllowedCollisionEntry,
    AllowedCollisionMatrix,
    AttachedCollisionObject,
    LinkPadding,
    LinkScale,
    ObjectColor,
    PlanningSceneComponents,
)
from moveit_msgs.msg import (
    CollisionObject as ObjectMessage,
)
from moveit_msgs.msg import (
    PlanningScene as SceneMessage,
)
from shape_msgs.msg import Mesh, Plane, SolidPrimitive

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.convert import pose_message, robot_state_message
from arm_planning.ros.convert_octomap import octomap_message
from arm_planning.ros.convert_shapes import solid_message
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.object_changes import explicit_pose
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.scene import PlanningScene

Parts = PlanningSceneComponents
EVERYTHING = 0xFFFFFFFF


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
