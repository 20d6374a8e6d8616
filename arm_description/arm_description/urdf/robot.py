"""The content of a URDF as frozen data: links, joints and the tree that they form.

SI units: m, rad, kg, N or N m, and per second. `line` is the line of the element in the parsed
text, 0 for objects that were made without a text.
"""

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING

from arm_description.errors import MimicCycleError, UrdfError
from arm_description.urdf.joint_type import JointType
from arm_node.frozen import frozen
from arm_node.names import listing
from arm_node.rigid_transform import rpy_from_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector = tuple[float, float, float]


@frozen
class Pose:
    """The pose of a frame in another: translation, then roll, pitch, yaw about fixed axes."""

    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)

    @classmethod
    def of(cls, matrix: "NDArray[np.float64]") -> "Pose":
        """Return the pose of a (4, 4) homogeneous transform."""
        x, y, z = matrix[:3, 3].tolist()
        return cls((x, y, z), rpy_from_rows(matrix[:3, :3].tolist()))

    def matrix(self) -> "NDArray[np.float64]":
        """Return the (4, 4) homogeneous transform."""
        # Imported here: reading a description, as the launcher does, needs no NumPy.
        from arm_description.transforms import rotation_from_rpy, transform

        return transform(rotation_from_rpy(self.rpy), self.xyz)


@frozen
class Inertial:
    """Mass, and the inertia (ixx, ixy, ixz, iyy, iyz, izz) about the axes of `origin`."""

    mass: float
    origin: Pose
    inertia: tuple[float, float, float, float, float, float]


@frozen
class Box:
    """A box with its full side lengths, centred."""

    size: Vector


@frozen
class Cylinder:
    """A cylinder along z, centred."""

    radius: float
    length: float


@frozen
class Sphere:
    """A sphere."""

    radius: float


@frozen
class Capsule:
    """A cylinder along z, centred, of `length` without its two hemispherical ends."""

    radius: float
    length: float


@frozen
class Mesh:
    """A mesh file as named in the URDF; see `resources.ResourceFinder`."""

    uri: str
    scale: Vector = (1.0, 1.0, 1.0)


Geometry = Box | Cylinder | Sphere | Capsule | Mesh


@frozen
class Material:
    """A colour (red, green, blue, alpha, each 0 to 1) or a texture's URI, or only a name."""

    name: str
    rgba: tuple[float, float, float, float] | None = None
    texture: str | None = None


@frozen
class Visual:
    """A visible shape."""

    name: str
    origin: Pose
    geometry: Geometry
    material: Material | None


@frozen
class Collision:
    """A collision shape."""

    name: str
    origin: Pose
    geometry: Geometry


@frozen
class Link:
    """A rigid body, or only a frame if it has neither mass nor shapes."""

    name: str
    inertial: Inertial | None = None
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    line: int = 0


@frozen
class JointLimit:
    """Bounds of a joint; a continuous joint has `lower` -inf and `upper` inf."""

    lower: float
    upper: float
    effort: float
    velocity: float


@frozen
class Dynamics:
    """Viscous damping and dry friction."""

    damping: float = 0.0
    friction: float = 0.0


@frozen
class Mimic:
    """Position = multiplier x position of `joint` + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def position(self, leader: float) -> float:
        """Return this joint's position for a position of `joint` (rad or m)."""
        return self.multiplier * leader + self.offset


@frozen
class SafetyLimits:
    """The safety_controller element; a missing soft limit is infinite."""

    soft_lower: float
    soft_upper: float
    k_position: float
    k_velocity: float


@frozen
class Joint:
    """The connection of a child link to its parent; `axis` is a unit vector in the joint's frame.

    The type may be given by its URDF name.
    """

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

    def __post_init__(self) -> None:
        # A frozen dataclass can set a derived attribute only this way.
        object.__setattr__(self, "type", JointType(self.type))


@frozen
class Robot:
    """Links and joints in document order; always one tree with one root link.

    Raises:
        UrdfError: names are repeated, a joint connects unknown links, there is no root or several,
            links form a loop, or a joint mimics an unknown one.
        MimicCycleError: joints mimic each other in a circle.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    root: str = field(init=False)
    _links: Mapping[str, Link] = field(init=False, repr=False, compare=False)
    _joints: Mapping[str, Joint] = field(init=False, repr=False, compare=False)
    _children: Mapping[str, tuple[Joint, ...]] = field(init=False, repr=False, compare=False)
    _mimics: Mapping[str, Mimic] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        children: dict[str, list[Joint]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint)
        object.__setattr__(self, "root", find_root(self.links, self.joints))
        check_mimics(self.joints)
        object.__setattr__(self, "_links", {link.name: link for link in self.links})
        object.__setattr__(self, "_joints", {joint.name: joint for joint in self.joints})
        object.__setattr__(
            self, "_children", {name: tuple(group) for name, group in children.items()}
        )
        mimics = {joint.name: joint.mimic for joint in self.joints if joint.mimic is not None}
        object.__setattr__(self, "_mimics", mimics)

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
        """Return the joints whose parent is this link, in document order."""
        return self._children.get(self.link(link).name, ())

    def leader_of(self, joint: str, known: Container[str] = ()) -> Mimic:
        """Return a joint's position as a function of its leader's; see `resolve_leader`."""
        return resolve_leader(joint, self._mimics, known)

    @property
    def movable_joints(self) -> tuple[Joint, ...]:
        """All joints except the fixed ones, in document order."""
        return tuple(joint for joint in self.joints if joint.type is not JointType.FIXED)

    @property
    def joints_in_tree_order(self) -> tuple[Joint, ...]:
        """All joints, each after its parent link's joint (depth first)."""
        return tuple(self._descend())

    def _descend(self) -> Iterator[Joint]:
        waiting = list(reversed(self._children.get(self.root, ())))
        while waiting:
            joint = waiting.pop()
            yield joint
            waiting.extend(reversed(self._children.get(joint.child, ())))


def resolve_leader(name: str, mimics: Mapping[str, Mimic], known: Container[str] = ()) -> Mimic:
    """Return a joint's position as a function of its leader's position.

    Args:
        name: the joint. A joint that is not a mimic joint is its own leader.
        mimics: the mimic rules by joint name.
        known: joints whose position is known: the nearest of them, including the joint itself, is
            the leader.

    Raises:
        MimicCycleError: the joints mimic each other in a circle.
    """
    chain = [name]
    multiplier, offset = 1.0, 0.0
    while name in mimics and name not in known:
        mimic = mimics[name]
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        name = mimic.joint
        if name in chain:
            # Same message as ROS 2's joint_state_publisher.
            raise MimicCycleError(f"Found an infinite recursive mimic chain: {[*chain, name]}")
        chain.append(name)
    return Mimic(name, multiplier, offset)


def find_root(links: Sequence[Link], joints: Sequence[Joint]) -> str:
    """Return the root link, after checking that the links form one tree.

    Raises:
        UrdfError: there are no links, a name is repeated, a joint connects unknown links, a link
            has two parents, there is no root or several, or links form a loop.
    """
    if not links:
        raise UrdfError("the robot has no links")
    _check_unique("link", links)
    _check_unique("joint", joints)
    parent_joints = _parent_joints(links, joints)
    roots = [link for link in links if link.name not in parent_joints]
    if len(roots) > 1:
        names = listing(f"'{link.name}' (line {link.line})" for link in roots)
        raise UrdfError(f"a robot has one root link, but these links have no parent joint: {names}")
    if roots:
        _check_no_loop(links, parent_joints, roots[0].name)
        return roots[0].name
    _check_no_loop(links, parent_joints, None)
    raise AssertionError("links without a root form a loop")


def check_mimics(joints: Sequence[Joint]) -> None:
    """Check that every mimic joint follows a free joint, directly or through others.

    Raises:
        UrdfError: a joint mimics one that does not exist.
        MimicCycleError: joints mimic each other in a circle.
    """
    by_name = {joint.name: joint for joint in joints}
    solved: set[str] = set()
    for joint in joints:
        chain: dict[str, None] = {}
        follower = joint
        while follower.mimic is not None and follower.name not in solved:
            chain[follower.name] = None
            leader = by_name.get(follower.mimic.joint)
            if leader is None:
                raise UrdfError(
                    f"line {follower.line}: joint '{follower.name}' mimics joint "
                    f"'{follower.mimic.joint}', which does not exist; the robot has "
                    f"{listing(by_name)}"
                )
            if leader.name in chain:
                raise MimicCycleError(
                    f"line {follower.line}: joints mimic each other in a circle: "
                    f"{_circle(chain, leader.name)}"
                )
            follower = leader
        solved.update(chain)


def _check_unique(kind: str, items: Sequence[Link] | Sequence[Joint]) -> None:
    lines: dict[str, int] = {}
    for item in items:
        if item.name in lines:
            raise UrdfError(
                f"line {item.line}: a second {kind} '{item.name}'; "
                f"the first is in line {lines[item.name]}"
            )
        lines[item.name] = item.line


def _parent_joints(links: Sequence[Link], joints: Sequence[Joint]) -> dict[str, Joint]:
    names = [link.name for link in links]
    known = set(names)
    parent_joints: dict[str, Joint] = {}
    for joint in joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in known:
                raise UrdfError(
                    f"line {joint.line}: joint '{joint.name}' has the {role} link '{name}', "
                    f"which does not exist; the robot has {listing(names)}"
                )
        if joint.child in parent_joints:
            raise UrdfError(
                f"line {joint.line}: link '{joint.child}' is the child of joint '{joint.name}' "
                f"and of joint '{parent_joints[joint.child].name}'; a link has one parent"
            )
        parent_joints[joint.child] = joint
    return parent_joints


def _check_no_loop(
    links: Sequence[Link], parent_joints: dict[str, Joint], root: str | None
) -> None:
    reached = {root}
    for link in links:
        path: dict[str, None] = {}
        name = link.name
        while name not in reached:
            if name in path:
                raise UrdfError(
                    f"line {parent_joints[name].line}: links are each other's parents in a "
                    f"circle: {_circle(path, name)}"
                )
            path[name] = None
            name = parent_joints[name].parent
        reached.update(path)


def _circle(path: dict[str, None], back_at: str) -> str:
    names = list(path)
    return " -> ".join([*names[names.index(back_at) :], back_at])
