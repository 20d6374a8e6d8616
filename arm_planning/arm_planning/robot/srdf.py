"""Reads and writes an SRDF: the groups, named states and allowed collisions that belong to a URDF.

As in srdfdom, a part that names what the robot does not have is left out with a warning: one SRDF
serves a robot with and without its gripper. A part that is not written as it must be is an error.
"""

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

from arm_description.errors import UrdfError, XmlError
from arm_description.urdf.element import Remark, UrdfElement
from arm_description.urdf.robot import Robot
from arm_node.names import describe_known, listing
from arm_planning.errors import SrdfError

_logger = logging.getLogger(__name__)

VIRTUAL_JOINT_TYPES = ("fixed", "planar", "floating")
NAMED = ("group", "group_state", "end_effector", "virtual_joint")
"""Elements that messages call by their names."""

Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class SrdfGroup:
    """A group as it is written; its joints are the union of all parts.

    Attributes:
        joints: joints by name.
        links: links by name; each stands for the joint that carries it.
        chains: (base link, tip link); each stands for the joints between them.
        subgroups: groups whose joints belong to this one, too.
    """

    joints: tuple[str, ...] = ()
    links: tuple[str, ...] = ()
    chains: tuple[Pair, ...] = ()
    subgroups: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EndEffector:
    """A group at the end of another one.

    Attributes:
        parent_link: the link that carries it.
        group: the group that it consists of.
        parent_group: the group that moves it; "" if that is left open.
    """

    parent_link: str
    group: str
    parent_group: str = ""


@dataclass(frozen=True, slots=True)
class VirtualJoint:
    """A joint between a fixed frame and a link: `type` is fixed, planar or floating."""

    name: str
    type: str
    parent_frame: str
    child_link: str


@dataclass(frozen=True, slots=True)
class Srdf:
    """The content of an SRDF, without what the robot does not have.

    Attributes:
        robot_name: the robot that it is for.
        groups: groups by name.
        states: values of joints in rad or m, by (group, state) and joint; a joint of several
            degrees of freedom has several.
        end_effectors: end effectors by name.
        virtual_joints: joints between fixed frames and links.
        passive_joints: joints without a motor.
        disabled: why two links may touch, such as "Adjacent"; the names of a key sorted.
        enabled: pairs that are checked even if a link of them may touch everything; sorted names.
        touching: links that may touch everything.
        properties: values of properties by (joint, property).
    """

    robot_name: str
    groups: Mapping[str, SrdfGroup] = field(default_factory=dict)
    states: Mapping[Pair, Mapping[str, tuple[float, ...]]] = field(default_factory=dict)
    end_effectors: Mapping[str, EndEffector] = field(default_factory=dict)
    virtual_joints: tuple[VirtualJoint, ...] = ()
    passive_joints: tuple[str, ...] = ()
    disabled: Mapping[Pair, str] = field(default_factory=dict)
    enabled: tuple[Pair, ...] = ()
    touching: tuple[str, ...] = ()
    properties: Mapping[Pair, str] = field(default_factory=dict)


def parse_srdf(
    text: str,
    robot: Robot,
    source: str = "robot_description_semantic",
    remark: Callable[[Remark], None] | None = None,
) -> Srdf:
    """Parse an SRDF.

    Args:
        text: the SRDF; a xacro file must be expanded first.
        robot: the robot that it is for.
        source: name of the text in messages.
        remark: receives problems that are not errors; by default they are logged.

    Raises:
        SrdfError: the text is not XML or not an SRDF; the message names source, line and element.
    """
    try:
        root = SrdfElement.parse(text, source, remark or _log)
        if root.tag != "robot":
            raise root.error("is not an SRDF; its outermost element is <robot>")
        return _SrdfReader(root, robot).read()
    except UrdfError as error:
        raise SrdfError(f"{source}, {error}") from error
    except XmlError as error:
        raise SrdfError(str(error)) from error


def _log(remark: Remark) -> None:
    _logger.warning("%s", remark)


class SrdfElement(UrdfElement):
    """An element of an SRDF, read attribute by attribute as those of a URDF."""

    __slots__ = ()

    @property
    def name(self) -> str:
        """The name of a group, a state and the like, "" for what they consist of."""
        is_part = self.parent is not None and self.parent.tag == self.tag
        return self.text("name") if self.tag in NAMED and not is_part else ""


class _SrdfReader:
    """Reads the parts of an SRDF, and leaves out what the robot does not have."""

    def __init__(self, root: UrdfElement, robot: Robot) -> None:
        self._root = root
        self._robot = robot
        self._known: dict[str, Iterable[str]] = {
            "link": {link.name for link in robot.links},
            "joint": {joint.name for joint in robot.joints},
        }

    def read(self) -> Srdf:
        name = self._root.needed_text("name")
        if name != self._robot.name:
            self._root.warn(f"is for the robot '{name}', but the URDF is of '{self._robot.name}'")
        virtual_joints = tuple(self._virtual_joints())
        # Groups and states may name virtual joints, which planning does not move.
        names = {*self._known["joint"], *(joint.name for joint in virtual_joints)}
        self._known["joint"] = names
        groups = dict(self._by_name("group"))
        self._known["group"] = groups
        return Srdf(
            robot_name=name,
            groups=self._groups(groups),
            states=dict(self._states()),
            end_effectors=dict(self._end_effectors()),
            virtual_joints=virtual_joints,
            passive_joints=tuple(self._names(self._root, "passive_joint", "joint")),
            disabled=dict(self._pairs("disable_collisions")),
            enabled=tuple(dict(self._pairs("enable_collisions"))),
            touching=tuple(self._names(self._root, "disable_default_collisions", "link", "link")),
            properties=dict(self._properties()),
        )

    def _groups(self, elements: Mapping[str, UrdfElement]) -> dict[str, SrdfGroup]:
        groups: dict[str, SrdfGroup] = {}
        for name, element in elements.items():
            groups[name] = SrdfGroup(
                tuple(self._names(element, "joint", "joint")),
                tuple(self._names(element, "link", "link")),
                tuple(self._chains(element)),
                tuple(self._names(element, "group", "group")),
            )
            if groups[name] == SrdfGroup():
                element.warn("is empty, so nothing can be planned for it")
        for name, element in elements.items():
            circle = _circle(name, groups)
            if circle:
                raise element.error(f"contains itself: {' -> '.join(circle)}")
        return groups

    def _chains(self, group: UrdfElement) -> Iterator[Pair]:
        for chain in group.children("chain"):
            base, tip = chain.needed_text("base_link"), chain.needed_text("tip_link")
            if self._exists(chain, "link", base) and self._exists(chain, "link", tip):
                yield base, tip

    def _states(self) -> Iterator[tuple[Pair, dict[str, tuple[float, ...]]]]:
        scalar = {joint.name for joint in self._robot.joints if joint.type.is_scalar}
        for element in self._root.children("group_state"):
            name, group = element.needed_text("name"), element.needed_text("group")
            values: dict[str, tuple[float, ...]] = {}
            for joint in element.children("joint"):
                joint_name = joint.needed_text("name")
                words = joint.needed_text("value").split()
                numbers = tuple(joint.number_of(word, "value=") for word in words)
                if joint_name in scalar and len(numbers) != 1:
                    raise joint.error(f"has {len(numbers)} values for '{joint_name}', not 1")
                if self._exists(joint, "joint", joint_name):
                    values[joint_name] = numbers
            if self._exists(element, "group", group):
                yield (group, name), values

    def _end_effectors(self) -> Iterator[tuple[str, EndEffector]]:
        for name, element in self._by_name("end_effector"):
            parent, group = element.needed_text("parent_link"), element.needed_text("group")
            parent_group = element.text("parent_group")
            groups = [each for each in (group, parent_group) if each]
            if self._exists(element, "link", parent) and all(
                self._exists(element, "group", each) for each in groups
            ):
                yield name, EndEffector(parent, group, parent_group)

    def _virtual_joints(self) -> Iterator[VirtualJoint]:
        for name, element in self._by_name("virtual_joint"):
            child, kind = element.needed_text("child_link"), element.needed_text("type")
            parent = element.needed_text("parent_frame")
            if kind not in VIRTUAL_JOINT_TYPES:
                kinds = listing(VIRTUAL_JOINT_TYPES)
                element.warn(f"has the type '{kind}' and is fixed instead; there are {kinds}")
                kind = "fixed"
            if self._exists(element, "link", child):
                yield VirtualJoint(name, kind, parent, child)

    def _pairs(self, tag: str) -> Iterator[tuple[Pair, str]]:
        """Yield pairs of links, each with its reason.

        A robot without its gripper lacks many of them, so one warning names all missing links.
        """
        missing: dict[str, UrdfElement] = {}
        for element in self._root.children(tag):
            pair = element.needed_text("link1"), element.needed_text("link2")
            unknown = [link for link in pair if link not in self._known["link"]]
            missing |= {link: element for link in unknown if link not in missing}
            if not unknown:
                yield (min(pair), max(pair)), element.text("reason")
        if missing:
            first = next(iter(missing.values()))
            first.warn(f"is left out: the robot does not have {listing(missing)}")

    def _properties(self) -> Iterator[tuple[Pair, str]]:
        for element in self._root.children("joint_property"):
            joint, name = element.needed_text("joint_name"), element.needed_text("property_name")
            if self._exists(element, "joint", joint):
                yield (joint, name), element.text("value")

    def _by_name(self, tag: str) -> Iterator[tuple[str, UrdfElement]]:
        """Yield the elements with a tag, whose names must differ."""
        lines: dict[str, int] = {}
        for element in self._root.children(tag):
            name = element.needed_text("name")
            if name in lines:
                raise element.error(f"is the second one; the first is in line {lines[name]}")
            lines[name] = element.line
            yield name, element

    def _names(
        self, parent: UrdfElement, tag: str, kind: str, attribute: str = "name"
    ) -> Iterator[str]:
        """Yield the names in an element's children that exist."""
        for element in parent.children(tag):
            name = element.needed_text(attribute)
            if self._exists(element, kind, name):
                yield name

    def _exists(self, element: UrdfElement, kind: str, name: str) -> bool:
        """Return whether a link, joint or group exists; warn if it does not."""
        known = self._known[kind]
        if name in known:
            return True
        owner = "the SRDF has" if kind == "group" else "the robot has"
        unknown = describe_known(name, known, owner)
        element.warn(f"is left out: there is no {kind} '{name}'; {unknown}")
        return False


def _circle(name: str, groups: Mapping[str, SrdfGroup]) -> list[str]:
    """Return how a group contains itself, as a path from it to it; [] if it does not."""
    paths = [[name]]
    seen: set[str] = set()
    while paths:
        path = paths.pop()
        for inner in groups[path[-1]].subgroups:
            if inner == name:
                return [*path, inner]
            if inner not in seen:
                seen.add(inner)
                paths.append([*path, inner])
    return []


def srdf_text(srdf: Srdf) -> str:
    """Return the text of an SRDF, which `parse_srdf` reads again."""
    lines = [
        f"<robot {_attributes(name=srdf.robot_name)}>",
        *(f"  {line}" for line in _parts(srdf)),
        "</robot>",
    ]
    return "\n".join(['<?xml version="1.0"?>', *lines, ""])


def _parts(srdf: Srdf) -> Iterator[str]:
    for name, group in srdf.groups.items():
        yield from _block("group", _attributes(name=name), _members(group))
    for (group, name), values in srdf.states.items():
        joints = [
            _empty("joint", name=joint, value=" ".join(f"{number!r}" for number in numbers))
            for joint, numbers in values.items()
        ]
        yield from _block("group_state", _attributes(name=name, group=group), joints)
    for name, each in srdf.end_effectors.items():
        more = {"parent_group": each.parent_group} if each.parent_group else {}
        yield _empty(
            "end_effector", name=name, parent_link=each.parent_link, group=each.group, **more
        )
    for each in srdf.virtual_joints:
        yield _empty(
            "virtual_joint",
            name=each.name,
            type=each.type,
            parent_frame=each.parent_frame,
            child_link=each.child_link,
        )
    for name in srdf.passive_joints:
        yield _empty("passive_joint", name=name)
    for (joint, name), value in srdf.properties.items():
        yield _empty("joint_property", joint_name=joint, property_name=name, value=value)
    for link in srdf.touching:
        yield _empty("disable_default_collisions", link=link)
    for first, second in srdf.enabled:
        yield _empty("enable_collisions", link1=first, link2=second)
    for (first, second), reason in srdf.disabled.items():
        yield _empty("disable_collisions", link1=first, link2=second, reason=reason)


def _members(group: SrdfGroup) -> list[str]:
    return [
        *(_empty("joint", name=name) for name in group.joints),
        *(_empty("link", name=name) for name in group.links),
        *(_empty("chain", base_link=base, tip_link=tip) for base, tip in group.chains),
        *(_empty("group", name=name) for name in group.subgroups),
    ]


def _block(tag: str, attributes: str, inside: list[str]) -> Iterator[str]:
    if not inside:
        yield f"<{tag} {attributes}/>"
        return
    yield f"<{tag} {attributes}>"
    yield from (f"  {line}" for line in inside)
    yield f"</{tag}>"


def _empty(tag: str, **attributes: str) -> str:
    return f"<{tag} {_attributes(**attributes)}/>"


def _attributes(**attributes: str) -> str:
    return " ".join(f"{name}={quoteattr(value)}" for name, value in attributes.items())
