"""Changes of the whole scene, full ones and diffs, by the rules of MoveIt's planning scene."""

import logging
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.attached_changes import AttachedChange, change_attached
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.object_changes import ObjectChange, Operation, change_object
from arm_planning.scene.object_checks import LARGEST_M, check_pose
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.octree import Cubes
from arm_planning.scene.scene import PlanningScene, Rgba

_logger = logging.getLogger(__name__)

Warn = Callable[[str], None]
"""Takes a sentence for the user about something that is not an error."""


@dataclass(frozen=True, slots=True)
class FixedTransform:
    """The pose of a frame in another; "" is the planning frame."""

    frame: str
    pose: RigidTransform


@dataclass(frozen=True, slots=True)
class OctomapChange:
    """A new octomap.

    Attributes:
        frame: where its pose is given; "" is the planning frame.
        pose: of its origin.
        resolution_m: edge of its smallest cube.
        cubes: occupied space; None to remove the octomap.
    """

    frame: str
    pose: RigidTransform
    resolution_m: float
    cubes: Cubes | None


@dataclass(frozen=True, slots=True)
class SceneChange:
    """A new scene, or what changes in one, in the words of moveit_msgs/PlanningScene.

    The default changes nothing.

    Attributes:
        is_diff: whether all that it does not name stays as it is.
        name: name of the scene.
        robot_name: name of the robot that it is for; "" for any.
        is_state_diff: whether attached bodies stay, if positions are given.
        positions: positions of active joints; the others stay.
        attached: what to attach and detach, in order.
        objects: what to do with objects in the world, in order; after what is attached.
        transforms: fixed frames by name.
        allowed: all pairs that may touch; None to leave them, or in a full scene for no pair.
        padding: how much links are grown, in m.
        scale: factors of links' sizes.
        colors: colours of objects, by id.
        octomap: what replaces the octomap; None to leave it, or in a full scene for none.
    """

    is_diff: bool = True
    name: str = ""
    robot_name: str = ""
    is_state_diff: bool = True
    positions: JointPositions = field(default_factory=dict)
    attached: tuple[AttachedChange, ...] = ()
    objects: tuple[ObjectChange, ...] = ()
    transforms: Mapping[str, FixedTransform] = field(default_factory=dict)
    allowed: AllowedCollisions | None = None
    padding: Mapping[str, float] = field(default_factory=dict)
    scale: Mapping[str, float] = field(default_factory=dict)
    colors: Mapping[str, Rgba] = field(default_factory=dict)
    octomap: OctomapChange | None = None


@dataclass(frozen=True, slots=True)
class SceneOutcome:
    """What a change led to: as in MoveIt, a part that fails leaves the others in force.

    Attributes:
        scene: the scene with all parts of the change that were possible.
        problems: why the others were not.
    """

    scene: PlanningScene
    problems: tuple[PlanningError, ...] = ()


def change_scene(
    model: PlanningModel,
    scene: PlanningScene,
    change: SceneChange,
    warn: Warn = _logger.warning,
) -> SceneOutcome:
    """Return the changed scene, and what of the change was not possible.

    Args:
        model: the robot.
        scene: the scene.
        change: what to do.
        warn: receives sentences about what is passed over; by default they are logged.
    """
    if change.robot_name not in ("", model.robot.name):
        warn(
            f"Setting the scene for model '{change.robot_name}' but model '{model.robot.name}' is "
            "loaded."
        )
    parts = _Parts(model, _named(scene, change) if change.is_diff else _emptied(scene, change))
    parts.take_positions(change)
    parts.take_attached(change)
    parts.take_transforms(change)
    for each in change.objects:
        parts.attempt(lambda scene, links, each=each: change_object(scene, links, each))
    octomap = change.octomap
    if octomap is not None:
        parts.attempt(lambda scene, links: _with_octomap(scene, links, octomap))
    parts.take_links("padding", change.padding, least=0.0)
    parts.take_links("scale", change.scale, least=math.ulp(0.0))
    parts.scene = replace(parts.scene, colors={**parts.scene.colors, **change.colors})
    _warn_of_touching(change, parts, warn)
    return SceneOutcome(parts.scene, tuple(parts.problems))


class _Parts:
    """A scene in the middle of a change; a part that fails leaves it as it is."""

    def __init__(self, model: PlanningModel, scene: PlanningScene) -> None:
        self.model = model
        self.scene = scene
        self.links = LinkPoses(model, scene.positions)
        self.problems: list[PlanningError] = []

    def attempt(self, step: Callable[[PlanningScene, LinkPoses], PlanningScene]) -> None:
        try:
            self.scene = step(self.scene, self.links)
        except PlanningError as problem:
            self.problems.append(problem)

    def take_positions(self, change: SceneChange) -> None:
        """Set the joints; a state that is not a diff starts without attached bodies.

        With one position that is not possible, none is set.
        """
        sentences: list[str] = []
        for joint, position in change.positions.items():
            if joint not in self.model.joints:
                known = describe_known(joint, self.model.joints, "the robot has")
                sentences.append(f"no active joint '{joint}'; {known}")
            elif not math.isfinite(position):
                sentences.append(f"the position of joint '{joint}' is {position}")
        for sentence in sentences:
            self._refuse(MoveItErrorCode.INVALID_ROBOT_STATE, sentence)
        if not change.positions or sentences:
            return
        self.scene = replace(self.scene, positions={**self.scene.positions, **change.positions})
        if not change.is_state_diff:
            self.scene = replace(self.scene, attached={})
        self.links = LinkPoses(self.model, self.scene.positions)

    def take_attached(self, change: SceneChange) -> None:
        for each in change.attached:
            if not change.is_state_diff and each.object.operation is not Operation.ADD:
                self._refuse(
                    MoveItErrorCode.INVALID_OBJECT_NAME,
                    f"object '{each.object.id}' is to be changed by a robot state that is not a "
                    "diff, which can only add; set is_diff of the state",
                )
            else:
                self.attempt(lambda scene, links, each=each: change_attached(scene, links, each))

    def take_transforms(self, change: SceneChange) -> None:
        for name, fixed in change.transforms.items():
            self.attempt(
                lambda scene, links, name=name, fixed=fixed: _with_transform(
                    scene, links, name, fixed
                )
            )

    def take_links(self, what: str, values: Mapping[str, float], least: float) -> None:
        """Set the padding or the scale of links."""
        for link, value in values.items():
            if link not in self.links.links:
                known = describe_known(link, self.links.links, "the robot has")
                self._refuse(
                    MoveItErrorCode.INVALID_LINK_NAME, f"{what} of no link '{link}'; {known}"
                )
            elif not least <= value <= LARGEST_M:
                bound = "not negative" if least == 0.0 else "above 0"
                bound += f" and at most {LARGEST_M:g}"
                sentence = f"the {what} of link '{link}' is {value}; it is {bound}"
                self._refuse(MoveItErrorCode.INVALID_LINK_NAME, sentence)
            else:
                after = {**getattr(self.scene, what), link: float(value)}
                self.scene = replace(self.scene, **{what: after})

    def _refuse(self, code: MoveItErrorCode, sentence: str) -> None:
        self.problems.append(PlanningError(code, sentence))


def _named(scene: PlanningScene, change: SceneChange) -> PlanningScene:
    allowed = scene.allowed if change.allowed is None else change.allowed
    return replace(scene, name=change.name or scene.name, allowed=allowed)


def _emptied(scene: PlanningScene, change: SceneChange) -> PlanningScene:
    """Return a scene of which only the robot's state is left."""
    return PlanningScene(
        positions=scene.positions,
        attached=scene.attached,
        allowed=change.allowed or AllowedCollisions(),
        name=change.name,
    )


def _with_transform(
    scene: PlanningScene, links: LinkPoses, name: str, fixed: FixedTransform
) -> PlanningScene:
    check_pose(fixed.pose, f"frame '{name}'")
    pose = frame_pose(scene, links, fixed.frame).then(fixed.pose)
    return replace(scene, transforms={**scene.transforms, name: pose})


def _with_octomap(scene: PlanningScene, links: LinkPoses, change: OctomapChange) -> PlanningScene:
    if change.cubes is None:
        return replace(scene, octomap=None)
    check_pose(change.pose, "the octomap")
    pose = frame_pose(scene, links, change.frame).then(change.pose)
    return replace(scene, octomap=OccupancyMap(change.resolution_m, change.cubes, pose))


def _warn_of_touching(change: SceneChange, parts: _Parts, warn: Warn) -> None:
    known = {*parts.links.links, *parts.scene.attached}
    for each in change.attached:
        for name in each.touch_links:
            if name not in known:
                warn(
                    f"object '{each.object.id}' may touch '{name}', which is neither a link nor "
                    "attached"
                )
