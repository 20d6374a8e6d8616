"""Changes of objects in the world, by the rules of MoveIt's planning scene."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import IntEnum

from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidObjectError, PlanningError
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.object_checks import check_pose, check_shapes
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.occupancy_map import OCTOMAP
from arm_planning.scene.scene import PlanningScene

NO_POSE = RigidTransform()


class Operation(IntEnum):
    """What to do with an object; the values are those of moveit_msgs/CollisionObject."""

    ADD = 0
    REMOVE = 1
    APPEND = 2
    MOVE = 3


@dataclass(frozen=True, slots=True)
class ObjectChange:
    """What to do with one object, in the words of moveit_msgs/CollisionObject.

    Attributes:
        operation: what to do.
        id: name of the object; "" removes all.
        frame: the frame that `pose` is in; "" for the planning frame.
        pose: pose of the object. An object of one shape without a pose of its own stands where its
            shape stands.
        shapes: its shapes, in its frame.
        subframes: named poses in its frame.
        type: its database key and type, ("", "") if unknown.
        shape_poses: new poses of its shapes, for MOVE; empty to keep them.
    """

    operation: Operation
    id: str
    frame: str = ""
    pose: RigidTransform = NO_POSE
    shapes: tuple[PlacedShape, ...] = ()
    subframes: Mapping[str, RigidTransform] = field(default_factory=dict)
    type: tuple[str, str] = ("", "")
    shape_poses: tuple[RigidTransform, ...] = ()


def change_object(scene: PlanningScene, links: LinkPoses, change: ObjectChange) -> PlanningScene:
    """Return the scene with an object added, extended, moved or removed.

    Args:
        scene: the scene.
        links: the poses of the links at the scene's positions.
        change: what to do.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: the object does not exist, its name is taken, or its
            pose or a shape is unusable. FRAME_TRANSFORM_FAILURE: its frame does not exist.
    """
    match change.operation:
        case Operation.REMOVE:
            return _removed(scene, change.id)
        case Operation.MOVE:
            return _moved(scene, links, change)
        case Operation.ADD | Operation.APPEND:
            _check_free(scene, change.id)
            added = placed_object(scene, links, change)
            known = scene.objects.get(added.id)
            if known is not None and change.operation is Operation.APPEND:
                added = joined(known, added)
            return _with(scene, added)


def placed_object(scene: PlanningScene, links: LinkPoses, change: ObjectChange) -> CollisionObject:
    """Return the object that a change adds, with its pose in the planning frame.

    Raises:
        PlanningError: see `change_object`.
    """
    owner = f"object '{change.id}'"
    _check_name(links, change.id)
    if not change.shapes:
        raise InvalidObjectError(f"{owner} has no shapes; give it a primitive, a mesh or a plane")
    check_poses(change)
    check_shapes(change.shapes, owner)
    inside = in_frame(change)
    pose = frame_pose(scene, links, change.frame).then(inside.pose)
    return replace(inside, pose=pose)


def explicit_pose(each: CollisionObject) -> RigidTransform:
    """Return the pose with which a change adds an object as it is.

    No pose and one shape means that the shape's pose is the object's. The same rotation written as
    (0, 0, 0, -1) is a pose.
    """
    if each.pose == NO_POSE and len(each.shapes) == 1:
        return RigidTransform(rotation=(0.0, 0.0, 0.0, -1.0))
    return each.pose


def joined(known: CollisionObject, added: CollisionObject) -> CollisionObject:
    """Return an object with the shapes and subframes of another, which stay where they are."""
    shift = known.pose.inverse().then(added.pose)
    shapes = [replace(placed, pose=shift.then(placed.pose)) for placed in added.shapes]
    subframes = {name: shift.then(pose) for name, pose in added.subframes.items()}
    return replace(
        known,
        shapes=(*known.shapes, *shapes),
        subframes={**known.subframes, **subframes},
        type=added.type if any(added.type) else known.type,
    )


def in_frame(change: ObjectChange) -> CollisionObject:
    """Return the object with its pose in the frame of the change."""
    pose, shapes = change.pose, change.shapes
    if pose == NO_POSE and len(shapes) == 1:
        pose, shapes = shapes[0].pose, (PlacedShape(shapes[0].shape),)
    return CollisionObject(change.id, pose, shapes, dict(change.subframes), change.type)


def _check_name(links: LinkPoses, name: str) -> None:
    """Refuse names that would mean two things in frames and in the matrix of allowed pairs."""
    if not name:
        raise InvalidObjectError("an object has no name; give it an id")
    if name == OCTOMAP:
        raise InvalidObjectError(
            f"the name '{OCTOMAP}' is kept for the octomap; give the object another id"
        )
    if name in links:
        raise InvalidObjectError(f"the robot has a link '{name}'; give the object another id")


def _check_free(scene: PlanningScene, name: str) -> None:
    if name in scene.attached:
        link = scene.attached[name].link
        raise InvalidObjectError(
            f"object '{name}' is attached to link '{link}'; detach it first, or give the new one "
            "another id"
        )


def check_poses(change: ObjectChange) -> None:
    """Refuse poses that are none.

    Raises:
        PlanningError: INVALID_OBJECT_NAME.
    """
    owner = f"object '{change.id}'"
    check_pose(change.pose, owner)
    for name, pose in change.subframes.items():
        check_pose(pose, f"the subframe '{name}' of {owner}")
    for pose in change.shape_poses:
        check_pose(pose, f"a shape of {owner}")


def _moved(scene: PlanningScene, links: LinkPoses, change: ObjectChange) -> PlanningScene:
    if change.id not in scene.objects:
        raise _missing(scene, change.id, "move")
    check_poses(change)
    known = scene.objects[change.id]
    shapes = known.shapes
    if change.shape_poses:
        if len(change.shape_poses) != len(shapes):
            raise InvalidObjectError(
                f"object '{change.id}' has {len(shapes)} shapes, but {len(change.shape_poses)} "
                "poses are given for them"
            )
        shapes = tuple(
            PlacedShape(placed.shape, pose)
            for placed, pose in zip(shapes, change.shape_poses, strict=True)
        )
    pose = frame_pose(scene, links, change.frame).then(change.pose)
    return _with(scene, replace(known, pose=pose, shapes=shapes))


def _removed(scene: PlanningScene, name: str) -> PlanningScene:
    if name and name not in scene.objects:
        raise _missing(scene, name, "remove")
    gone = {name} if name else set(scene.objects)
    return replace(
        scene,
        objects={key: each for key, each in scene.objects.items() if key not in gone},
        colors={key: color for key, color in scene.colors.items() if key not in gone},
        allowed=_without(scene.allowed, gone),
    )


def _without(allowed: AllowedCollisions, names: set[str]) -> AllowedCollisions:
    return AllowedCollisions(
        {pair: value for pair, value in allowed.pairs.items() if names.isdisjoint(pair)},
        {name: value for name, value in allowed.defaults.items() if name not in names},
    )


def _missing(scene: PlanningScene, name: str, verb: str) -> PlanningError:
    hint = describe_known(name, scene.objects, "the world has")
    if name in scene.attached:
        hint = f"it is attached to link '{scene.attached[name].link}', detach it first"
    return InvalidObjectError(f"World object '{name}' does not exist. Cannot {verb}; {hint}")


def _with(scene: PlanningScene, each: CollisionObject) -> PlanningScene:
    return replace(scene, objects={**scene.objects, each.id: each})
