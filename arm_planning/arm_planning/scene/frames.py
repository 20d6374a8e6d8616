"""Where the frames of a scene are: links, objects, their subframes, and fixed transforms."""

import math
from collections.abc import Iterator

from arm_description.transforms import quaternion_from_rpy
from arm_description.urdf.robot import Joint
from arm_node.names import describe_known, listing
from arm_node.rigid_transform import Quaternion, RigidTransform
from arm_planning.errors import InvalidLinkError, MoveItErrorCode, PlanningError
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.scene import PlanningScene


class LinkPoses:
    """Poses of a robot's links in the planning frame, each computed when it is first asked for.

    Floating and planar joints stay at their origin. For one thread at a time.

    Args:
        model: the robot.
        positions: positions of its active joints; a joint without one is at 0.

    Attributes:
        links: the names of all links.
    """

    def __init__(self, model: PlanningModel, positions: JointPositions) -> None:
        self.links = tuple(link.name for link in model.robot.links)
        self._robot = model.robot
        self._positions = positions
        self._carriers = {joint.child: joint for joint in model.robot.joints}
        # The planning frame may also be the parent of a virtual joint, which is at the root.
        self._poses = {model.robot.root: RigidTransform(), model.frame: RigidTransform()}

    def __contains__(self, frame: str) -> bool:
        """Return whether a frame is a link or the planning frame."""
        return frame in self._poses or frame in self._carriers

    def __getitem__(self, link: str) -> RigidTransform:
        """Return the pose of a link, or of the planning frame itself; KeyError for another name."""
        above: list[Joint] = []
        while link not in self._poses:
            above.append(self._carriers[link])
            link = above[-1].parent
        pose = self._poses[link]
        for joint in reversed(above):
            pose = pose.then(RigidTransform(joint.origin.xyz, _rotation(joint)))
            pose = self._poses[joint.child] = pose.then(self._motion(joint))
        return pose

    def of(self, link: str) -> RigidTransform:
        """Return the pose of a link, or of the planning frame itself.

        Raises:
            PlanningError: INVALID_LINK_NAME: there is no such link.
        """
        if link not in self:
            raise InvalidLinkError(f"no link '{link}'; the robot has {listing(self.links)}")
        return self[link]

    def _motion(self, joint: Joint) -> RigidTransform:
        if not joint.type.is_scalar:
            return RigidTransform()
        rule = self._robot.leader_of(joint.name, self._positions)
        position = rule.position(self._positions.get(rule.joint, 0.0))
        x, y, z = joint.axis
        if joint.type.slides:
            return RigidTransform((x * position, y * position, z * position))
        sine = math.sin(position / 2)
        return RigidTransform(rotation=(x * sine, y * sine, z * sine, math.cos(position / 2)))


def frame_pose(scene: PlanningScene, links: LinkPoses, name: str) -> RigidTransform:
    """Return the pose of a frame in the planning frame.

    Args:
        scene: the scene.
        links: the poses of the links at the scene's positions.
        name: a link, an attached body, an object, "id/subframe" or a fixed transform; "" for the
            planning frame. A leading slash counts for nothing. The first that has the name wins.

    Raises:
        PlanningError: FRAME_TRANSFORM_FAILURE: no frame has the name; near names are offered.
    """
    name = name.removeprefix("/")
    if not name:
        return RigidTransform()
    if name in links:
        return links[name]
    for owner, subframe in _readings(name):
        if owner in scene.attached:
            body = scene.attached[owner]
            pose = _in_object(body.object, subframe)
            if pose is not None:
                return links[body.link].then(pose)
        if owner in scene.objects:
            pose = _in_object(scene.objects[owner], subframe)
            if pose is not None:
                return pose
    if name in scene.transforms:
        return scene.transforms[name]
    known = describe_known(name, frame_names(scene, links), "the frames are")
    raise PlanningError(MoveItErrorCode.FRAME_TRANSFORM_FAILURE, f"Unknown frame: {name}; {known}")


def frame_names(scene: PlanningScene, links: LinkPoses) -> list[str]:
    """Return the names of all frames of a scene."""
    bodies = [*scene.objects.values(), *(body.object for body in scene.attached.values())]
    subframes = [f"{body.id}/{name}" for body in bodies for name in body.subframes]
    return [*links.links, *(body.id for body in bodies), *subframes, *scene.transforms]


def _readings(name: str) -> Iterator[tuple[str, str | None]]:
    """Yield what a name may mean as (object, subframe); both may have slashes in them."""
    yield name, None
    for index, letter in enumerate(name):
        if letter == "/":
            yield name[:index], name[index + 1 :]


def _in_object(body: CollisionObject, subframe: str | None) -> RigidTransform | None:
    if subframe is None:
        return body.pose
    if subframe in body.subframes:
        return body.pose.then(body.subframes[subframe])
    return None


def _rotation(joint: Joint) -> Quaternion:
    if not any(joint.origin.rpy):
        return (0.0, 0.0, 0.0, 1.0)
    x, y, z, w = quaternion_from_rpy(joint.origin.rpy).tolist()
    return (x, y, z, w)
