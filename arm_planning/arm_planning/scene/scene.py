"""The planning scene as one immutable value: a change makes a new scene."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointPositions
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.occupancy_map import OCTOMAP, OccupancyMap

Rgba = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class PlanningScene:
    """What planning knows about the robot and its surroundings.

    Attributes:
        positions: position of each active joint of the robot.
        objects: objects in the world, by id.
        attached: objects on the robot, by id.
        allowed: pairs that may touch.
        padding: how much each link is grown against the world, in m; 0 for links not named.
        scale: factor of each link's size against the world; 1 for links not named.
        transforms: fixed frames in the planning frame, by name.
        colors: colours of objects, by id.
        name: its name.
        octomap: occupied space; None if there is none.
    """

    positions: JointPositions
    objects: Mapping[str, CollisionObject] = field(default_factory=dict)
    attached: Mapping[str, AttachedBody] = field(default_factory=dict)
    allowed: AllowedCollisions = AllowedCollisions()
    padding: Mapping[str, float] = field(default_factory=dict)
    scale: Mapping[str, float] = field(default_factory=dict)
    transforms: Mapping[str, RigidTransform] = field(default_factory=dict)
    colors: Mapping[str, Rgba] = field(default_factory=dict)
    name: str = "(noname)"
    octomap: OccupancyMap | None = None

    @property
    def obstacles(self) -> Mapping[str, CollisionObject]:
        """What the robot must not touch: the objects, and the octomap as one more."""
        if self.octomap is None:
            return self.objects
        return {**self.objects, OCTOMAP: self.octomap.obstacle}
