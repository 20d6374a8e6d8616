"""What a URDF says, as frozen data: links, joints and the tree that they make.

SI units: m, rad, kg, N or N m, and per second. `line` is the line of the element in the text
that was parsed, 0 for what was made without a text.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import UrdfError
from arm_description.names import listing
from arm_description.robot_tree import check_mimics, find_root
from arm_description.transforms import rotation_from_rpy, transform

Vector = tuple[float, float, float]
JointType = Literal["fixed", "revolute", "continuous", "prismatic", "floating", "planar"]


@dataclass(frozen=True, slots=True)
class Pose:
    """A frame in another: translation, then roll, pitch, yaw about the fixed axes."""

    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)

    def matrix(self) -> NDArray[np.float64]:
        """Return the (4, 4) homogeneous transform."""
        return transform(rotation_from_rpy(self.rpy), self.xyz)


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass, and the inertia (ixx, ixy, ixz, iyy, iyz, izz) about the axes of `origin`."""

    mass: float
    origin: Pose
    inertia: tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """A box with its full side lengths, centred."""

    size: Vector


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along z, centred."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere."""

    radius: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """A cylinder along z, centred, of `length` without the half spheres that close it."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file, named as the URDF names it; see `resources.resolve_uri`."""

    uri: str
    scale: Vector = (1.0, 1.0, 1.0)


Geometry = Box | Cylinder | Sphere | Capsule | Mesh


@dataclass(frozen=True, slots=True)
class Material:
    """A colour (red, green, blue, alpha, each 0 to 1) or a texture's URI, or only a name."""

    name: str
    rgba: tuple[float, float, float, float] | None = None
    texture: str | None = None


@dataclass(frozen=True, slots=True)
class Visual:
    """A shape to be seen."""

    name: str
    origin: Pose
    geometry: Geometry
    material: Material | None


@dataclass(frozen=True, slots=True)
class Collision:
    """A shape to be touched."""

    name: str
    origin: Pose
    geometry: Geometry


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid body, or a mere frame where it has neither mass nor shapes."""

    name: str
    inertial: Inertial | None = None
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    line: int = 0


@dataclass(frozen=True, slots=True)
class JointLimit:
    """Bounds of a joint; a continuous joint has `lower` -inf and `upper` inf."""

    lower: float
    upper: float
    effort: float
    velocity: float


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Viscous damping and dry friction."""

    damping: float = 0.0
    friction: float = 0.0


@dataclass(frozen=True, slots=True)
class Mimic:
    """Position = multiplier x position of `joint` + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class SafetyLimits:
    """The safety_controller element; a soft bound that is not given is infinite."""

    soft_lower: float
    soft_upper: float
    k_position: float
    k_velocity: float


@dataclass(frozen=True, slots=True)
class Joint:
    """What ties a child link to its parent; `axis` is a unit vector in the joint's frame."""

    name: str
    type: JointType
    parent: str
    child: str
    origin: Pose = Pose()
    axis: Vector = (1.0, 0.0, 0.0)
    limit: JointLimit | None = None
    dynamics: Dynamics = Dynamics()
    mimic: Mimic | None = None
    safety: SafetyLimits | None = None
    line: int = 0


@dataclass(frozen=True, slots=True)
class Robot:
    """Links and joints, in the document's order; always one tree with one root link.

    Raises:
        UrdfError: duplicate names, a joint between unknown links, no or several roots, a loop,
            a mimic of an unknown joint; MimicCycleError where joints mimic in a circle.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    root: str = field(init=False)
    _links: Mapping[str, Link] = field(init=False, repr=False, compare=False)
    _joints: Mapping[str, Joint] = field(init=False, repr=False, compare=False)
    _children: Mapping[str, tuple[Joint, ...]] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        children: dict[str, list[Joint]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint)
        # A frozen dataclass sets what it derives this way.
        object.__setattr__(self, "root", find_root(self.links, self.joints))
        check_mimics(self.joints)
        object.__setattr__(self, "_links", {link.name: link for link in self.links})
        object.__setattr__(self, "_joints", {joint.name: joint for joint in self.joints})
        object.__setattr__(
            self, "_children", {name: tuple(group) for name, group in children.items()}
        )

    def link(self, name: str) -> Link:
        """Return a link by name; UrdfError names those that exist."""
        if name not in self._links:
            raise UrdfError(f"no link '{name}'; the robot has {listing(self._links)}")
        return self._links[name]

    def joint(self, name: str) -> Joint:
        """Return a joint by name; UrdfError names those that exist."""
        if name not in self._joints:
            raise UrdfError(f"no joint '{name}'; the robot has {listing(self._joints)}")
        return self._joints[name]

    def children(self, link: str) -> tuple[Joint, ...]:
        """Return the joints whose parent is this link, in the document's order."""
        return self._children.get(self.link(link).name, ())

    @property
    def movable_joints(self) -> tuple[Joint, ...]:
        """All joints but the fixed ones, in the document's order."""
        return tuple(joint for joint in self.joints if joint.type != "fixed")

    @property
    def joints_in_tree_order(self) -> tuple[Joint, ...]:
        """All joints, each after the joint that carries its parent link (depth first)."""
        return tuple(self._descend())

    def _descend(self) -> Iterator[Joint]:
        waiting = list(reversed(self._children.get(self.root, ())))
        while waiting:
            joint = waiting.pop()
            yield joint
            waiting.extend(reversed(self._children.get(joint.child, ())))
