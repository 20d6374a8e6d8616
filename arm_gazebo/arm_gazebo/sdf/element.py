"""An element of an SDF file that keeps track of what has been read from it."""

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Self

import lxml.etree as etree
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import XmlError
from arm_description.mesh.data import Color
from arm_description.transforms import rotation_from_quaternion, rotation_from_rpy, transform
from arm_description.urdf.xml_document import XmlElement
from arm_gazebo.build_report import BuildOutcome, Finding, as_one
from arm_gazebo.errors import WorldError
from arm_node.frozen import frozen
from arm_node.user_file import read_text

IGNORED_ATTRIBUTES = frozenset({"name", "attached_to", "canonical_link", "version"})
"""Attributes that have no effect if they are not read, because a model is one rigid body."""
MODEL_FILE = "model.sdf"
SCENE_ELEMENTS = frozenset(
    {
        *("actor", "joint", "gripper", "light", "sensor", "road", "population"),
        *("particle_emitter", "projector", "wind", "model", "include"),
    }
)
"""Elements that add something to the scene, or move it."""
EMPTY_SHAPES = frozenset({"empty"})
"""The children of <geometry> that are not shapes."""
SYSTEM_PLUGINS = (
    *("physics", "scenebroadcaster", "usercommands", "sensors", "contact", "imu", "altimeter"),
    *("magnetometer", "airpressure", "navsat", "forcetorque", "ros", "rosinit", "rosfactory"),
    *("rosstate", "rosclock", "levels", "worldcontrol", "logicalcamera", "logrecord"),
)
"""World plugins that Gazebo itself needs; the simulation does not."""
RIGID = "the links of a model are one rigid body"
NOT_SIMULATED = "it is not simulated"
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


@frozen
class SdfPose:
    """A pose as written: (4, 4) in the frame `relative_to`, "" for the default frame."""

    matrix: NDArray[np.float64]
    relative_to: str = ""


@frozen
class SdfFile:
    """A file that elements are read from.

    Attributes:
        path: the file; plain paths in it are relative to its folder.
        includers: the chain of files that led here by <include>, the outermost first.
    """

    path: Path
    includers: tuple[Path, ...] = ()


class SdfElement(XmlElement[SdfFile]):
    """An element of an SDF file; most of its values are the texts of its children.

    Every method raises WorldError for an invalid value; the message names the file, the line and
    the element. `home` is the file.
    """

    __slots__ = ("_left_out", "_read_attributes", "_read_tags")

    def __init__(self, element: etree._Element, home: SdfFile, parent: Self | None = None) -> None:
        super().__init__(element, home, parent)
        self._read_tags: dict[str, Sequence[SdfElement]] = {}
        self._read_attributes: frozenset[str] = frozenset()
        self._left_out = ""

    @classmethod
    def read(cls, path: Path, includers: tuple[Path, ...] = ()) -> "SdfElement":
        """Return the root of a file, an <sdf> element."""
        try:
            text = read_text(path)
        except (OSError, UnicodeDecodeError) as error:
            raise WorldError(f"cannot read {path}: {error}") from error
        return cls.of_text(text, path, includers)

    @classmethod
    def of_text(cls, text: str, source: Path, includers: tuple[Path, ...] = ()) -> "SdfElement":
        """Return the root of a text, an <sdf> element; plain paths are relative to the source."""
        try:
            read = cls.parse(text, str(source), SdfFile(source, includers))
        except XmlError as error:
            raise WorldError(str(error)) from error
        if read.tag != "sdf":
            raise read.error("is not SDF; the root element must be <sdf>")
        return read

    @property
    def source(self) -> Path:
        """The file that it is read from."""
        return self.home.path

    @property
    def file_label(self) -> str:
        """The file's name in messages, with its folder if the name is the usual `model.sdf`."""
        path = self.source
        return f"{path.parent.name}/{path.name}" if path.name == MODEL_FILE else path.name

    @property
    def name(self) -> str:
        """The attribute `name`, "" if there is none."""
        return self.get("name").strip()

    def attribute(self, key: str) -> str:
        """Return an attribute without surrounding blanks, "" if there is none."""
        self._read_attributes |= {key}
        return self.get(key).strip()

    def boolean(self, key: str) -> bool:
        """Return an attribute as a boolean, False if there is none."""
        text = self.attribute(key).lower() or "false"
        if text not in _BOOLEANS:
            raise self.error(f"has {key}='{text}', which is neither true nor false")
        return _BOOLEANS[text]

    def error(self, problem: str) -> WorldError:
        """Return an error that names file, line and element."""
        return WorldError(f"{self.source}, line {self.line}: {self.label} {problem}")

    def leave_out(self, reason: str) -> None:
        """Report this element as left out, for a reason, instead of what is unread in it."""
        self._left_out = reason

    def children(self, tag: str) -> "Sequence[SdfElement]":
        """Return the children with this tag, which count as read."""
        if tag not in self._read_tags:
            self._read_tags[tag] = self.find(tag)
        return self._read_tags[tag]

    def child(self, tag: str) -> "SdfElement | None":
        """Return the first child with this tag, or None."""
        found = self.children(tag)
        return found[0] if found else None

    def required(self, tag: str) -> "SdfElement":
        """Return the first child with this tag, which must exist."""
        child = self.child(tag)
        if child is None:
            raise self.error(f"needs a <{tag}>")
        return child

    def at(self, *tags: str) -> "SdfElement | None":
        """Return the element at the end of a path of first children, or None."""
        element: SdfElement | None = self
        for tag in tags:
            element = element and element.child(tag)
        return element

    def text(self, tag: str, default: str = "") -> str:
        """Return the text of a child, or a default."""
        child = self.child(tag)
        return default if child is None else child.content

    def flag(self, tag: str) -> bool:
        """Return a child's text as a boolean; False if there is no such child."""
        child = self.child(tag)
        if child is None:
            return False
        if child.content.lower() not in _BOOLEANS:
            raise child.error(f"has '{child.content}', which is neither true nor false")
        return _BOOLEANS[child.content.lower()]

    def number(self, tag: str, default: float | None = None) -> float:
        """Return the number of a child, which must exist unless there is a default."""
        return self.numbers(tag, 1, None if default is None else (default,))[0]

    def size(self, tag: str) -> float:
        """Return the number of a child, which must exist and be above 0."""
        value = self.number(tag)
        if value <= 0:
            raise self.required(tag).error(f"has {value:g}; it must be above 0")
        return value

    def numbers(
        self, tag: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """Return the numbers of a child, which must exist unless there is a default."""
        child = self.child(tag)
        if child is None and default is not None:
            return default
        child = self.required(tag)
        return child.numbers_of(child.content, (count,))

    def color(self, tag: str, default: Color | None = None) -> Color:
        """Return the colour of a child, which must exist unless there is a default.

        The alpha value is 1 by default.
        """
        if self.child(tag) is None and default is not None:
            return default
        child = self.required(tag)
        r, g, b, a = (*child.numbers_of(child.content, (3, 4)), 1.0)[:4]
        return r, g, b, a

    def pose(self) -> SdfPose:
        """Return the pose in this element's <pose>, or no displacement."""
        pose = self.child("pose")
        if pose is None:
            return SdfPose(np.eye(4))
        matrix = pose._transform() if pose.content else np.eye(4)
        return SdfPose(matrix, pose.attribute("relative_to"))

    def _transform(self) -> NDArray[np.float64]:
        """Return the transform (4, 4) that a <pose> holds."""
        match self.attribute("rotation_format"):
            case "" | "euler_rpy":
                x, y, z, *rpy = self.numbers_of(self.content, (6,))
                if self.boolean("degrees"):
                    rpy = [math.radians(angle) for angle in rpy]
                return transform(rotation_from_rpy(rpy), (x, y, z))
            case "quat_xyzw":
                x, y, z, *quaternion = self.numbers_of(self.content, (7,))
                norm = math.hypot(*quaternion)
                if norm == 0.0:
                    raise self.error("has a quaternion of length 0")
                unit = np.array(quaternion) / norm
                return transform(rotation_from_quaternion(unit), (x, y, z))
            case other:
                raise self.error(
                    f"has the rotation_format {other!r}; there is euler_rpy, quat_xyzw"
                )

    def unread(self) -> "Iterator[Unread]":
        """Yield the elements and attributes that have not been read."""
        if self._left_out:
            yield Unread(self, BuildOutcome.LEFT_OUT, self._left_out)
            return
        # Old SDF versions write empty attributes; "{...}" is a namespace.
        for name, value in self.attributes.items():
            if (
                value.strip()
                and name[0] != "{"
                and name not in self._read_attributes | IGNORED_ATTRIBUTES
            ):
                yield Unread(self, BuildOutcome.DROPPED, NOT_SIMULATED, name)
        for child in self.elements:
            if child.tag not in self._read_tags:
                outcome = _unread_outcome(child)
                if outcome:
                    yield Unread(child, *outcome)
        for children in self._read_tags.values():
            for child in children:
                yield from child.unread()


@frozen
class Unread:
    """An element that has not been read, or an unread attribute of an element that has.

    Attributes:
        element: the element.
        outcome: what happens to it.
        reason: why.
        key: name of the attribute, "" for the element itself.
    """

    element: SdfElement
    outcome: BuildOutcome
    reason: str
    key: str = ""

    @property
    def label(self) -> str:
        """Its name in messages."""
        name = self.element.label
        return f"{self.key}='{self.element.attribute(self.key)}' of {name}" if self.key else name


def unread_findings(read: Iterable[SdfElement]) -> Iterator[Finding]:
    """Return a finding for each kind of unread element and attribute in each file."""
    alike: dict[tuple[Path, str, str, BuildOutcome], list[Finding]] = {}
    for unread in (each for root in read for each in root.unread()):
        element = unread.element
        kind = (element.source, element.tag, unread.key, unread.outcome)
        what = f"{unread.label} in {element.file_label}"
        finding = Finding(unread.outcome, what, unread.reason, element.line)
        alike.setdefault(kind, []).append(finding)
    return map(as_one, alike.values())


def _unread_outcome(element: SdfElement) -> tuple[BuildOutcome, str] | None:
    """Return what happens to an unread element, and why; None if nothing is missing."""
    tag, parent = element.tag, element.parent.tag if element.parent else ""
    if tag == "joint":
        # A fixed joint changes nothing: the links of a model are one rigid body anyway.
        return None if element.get("type") == "fixed" else (BuildOutcome.LEFT_OUT, RIGID)
    if parent == "geometry":
        return None if tag in EMPTY_SHAPES else (BuildOutcome.LEFT_OUT, NOT_SIMULATED)
    if tag in SCENE_ELEMENTS or (tag == "plugin" and not _is_system_plugin(element)):
        return BuildOutcome.LEFT_OUT, NOT_SIMULATED
    return BuildOutcome.DROPPED, NOT_SIMULATED


def _is_system_plugin(plugin: SdfElement) -> bool:
    """Return whether a plugin is one of Gazebo's own systems."""
    file = plugin.get("filename").lower().removeprefix("lib").removesuffix(".so")
    words = file.replace("_", "-").split("-")
    plain = [word for word in words if word not in ("gz", "ignition", "gazebo", "sim", "system")]
    return (
        plugin.parent is not None
        and plugin.parent.tag == "world"
        and "".join(word for word in plain if not word[:1].isdigit()) in SYSTEM_PLUGINS
    )
