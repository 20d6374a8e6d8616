"""Changes of what is attached to the robot, by the rules of MoveIt's planning scene."""

from dataclasses import dataclass, replace

from arm_node.names import describe_known
from arm_planning.errors import InvalidLinkError, InvalidObjectError
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.object_changes import (
    ObjectChange,
    Operation,
    check_poses,
    in_frame,
    joined,
    placed_object,
)
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Plane


@dataclass(frozen=True, slots=True)
class AttachedChange:
    """What to attach or detach, in the words of moveit_msgs/AttachedCollisionObject.

    Attributes:
        object: the object, by ADD, APPEND or REMOVE. Without shapes, ADD takes the world's object
            of that name; REMOVE without a name detaches all from the link, or from all links.
        link: the link; "" for any, in REMOVE.
        touch_links: links and attached bodies that it may touch.
    """

    object: ObjectChange
    link: str = ""
    touch_links: tuple[str, ...] = ()


def change_attached(
    scene: PlanningScene, links: LinkPoses, change: AttachedChange
) -> PlanningScene:
    """Return the scene with an object attached, extended or detached.

    Args:
        scene: the scene.
        links: the poses of the links at the scene's positions.
        change: what to do.

    Raises:
        PlanningError: INVALID_LINK_NAME: the link does not exist. INVALID_OBJECT_NAME: the object
            does not exist or is unusable. FRAME_TRANSFORM_FAILURE: its frame does not exist.
    """
    match change.object.operation:
        case Operation.REMOVE:
            return _detached(scene, links, change)
        case Operation.MOVE:
            raise InvalidObjectError(
                f"object '{change.object.id}' is attached and cannot be moved; attach it again at "
                "its new pose"
            )
        case Operation.ADD | Operation.APPEND:
            return _attached(scene, links, change)


def _attached(scene: PlanningScene, links: LinkPoses, change: AttachedChange) -> PlanningScene:
    name = change.object.id
    _check_link(change.link, links)
    known, touching = scene.attached.get(name), frozenset(change.touch_links)
    body = _source(scene, links, change)
    if known is not None and change.object.operation is Operation.APPEND:
        before = replace(known.object, pose=links[known.link].then(known.object.pose))
        body, touching = joined(before, body), touching | known.touch_links
    if any(isinstance(placed.shape, Plane) for placed in body.shapes):
        raise InvalidObjectError(f"object '{name}' has a plane, which cannot be attached to a link")
    pose = links[change.link].inverse().then(body.pose)
    if change.object.shapes and change.object.frame == change.link and known is None:
        # Clients send scenes back: what is given in the link's own frame stays so to the bit.
        pose = in_frame(change.object).pose
    attached = AttachedBody(replace(body, pose=pose), change.link, touching)
    objects = {key: each for key, each in scene.objects.items() if key != name}
    return replace(scene, attached={**scene.attached, name: attached}, objects=objects)


def _source(scene: PlanningScene, links: LinkPoses, change: AttachedChange) -> CollisionObject:
    """Return the object to attach, its pose in the planning frame."""
    asked, name = change.object, change.object.id
    if asked.shapes:
        return placed_object(scene, links, asked)
    if name not in scene.objects:
        raise InvalidObjectError(
            f"Attempting to attach object '{name}' to link '{change.link}' but no geometry "
            f"specified and such an object does not exist in the collision world; "
            f"{describe_known(name, scene.objects, 'the world has')}"
        )
    check_poses(asked)
    known = scene.objects[name]
    return replace(known, subframes={**known.subframes, **asked.subframes})


def _detached(scene: PlanningScene, links: LinkPoses, change: AttachedChange) -> PlanningScene:
    name, link = change.object.id, change.link
    if link:
        _check_link(link, links)
    if name and name not in scene.attached:
        known = describe_known(name, scene.attached, "the robot holds")
        raise InvalidObjectError(f"object '{name}' is not attached; {known}")
    if name and link not in ("", scene.attached[name].link):
        where = scene.attached[name].link
        raise InvalidObjectError(f"object '{name}' is attached to link '{where}', not to '{link}'")
    leaving = {
        key: body
        for key, body in scene.attached.items()
        if (not name or key == name) and link in ("", body.link)
    }
    freed = {
        key: replace(body.object, pose=links[body.link].then(body.object.pose))
        for key, body in leaving.items()
    }
    rest = {key: body for key, body in scene.attached.items() if key not in leaving}
    return replace(scene, attached=rest, objects={**scene.objects, **freed})


def _check_link(link: str, links: LinkPoses) -> None:
    if link not in links.links:
        known = describe_known(link, links.links, "the robot has")
        raise InvalidLinkError(f"no link '{link}'; {known}")
