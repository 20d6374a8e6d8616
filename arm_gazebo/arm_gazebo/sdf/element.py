"""An element of an SDF file that keeps track of what has been read from it."""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import lxml.etree as etree
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import XmlError
from arm_description.mesh.data import Color
from arm_description.transforms import rotation_from_quaternion, rotation_from_rpy, transform
from arm_description.urdf.element import written_name
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.build_report import BuildOutcome, Finding
from arm_gazebo.errors import WorldError
from arm_gazebo.sdf.unread import NOT_SIMULATED, unread_outcome
from arm_node.user_file import read_text

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
IGNORED_ATTRIBUTES = frozenset({"name", "attached_to", "canonical_link", "version"})
"""Attributes that have no effect if they are not read, because a model is one rigid body."""
MODEL_FILE = "model.sdf"
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True, slots=True)
class SdfPose:
    """A pose as written: (4, 4) in the frame `relative_to`, "" for the default frame."""

    matrix: NDArray[np.float64]
    relative_to: str = ""


class SdfElement:
    """An element of an SDF file; most of its values are the texts of its children.

    Every method raises WorldError for an invalid value; the message names the file, the line and
    the element.
    """

    def __init__(
        self,
        element: etree._Element,
        source: Path,
        owner: str = "",
        includers: tuple[Path, ...] = (),
    ) -> None:
        self._element = element
        self._owner = owner
        self._children: dict[str, list[SdfElement]] = {}
        self._read_attributes: set[str] = set()
        self._left_out = ""
        self.source = source
        self.includers = includers
        """The chain of files that led here by <include>, the outermost first."""

    @classmethod
    def read(cls, path: Path, includers: tuple[Path, ...] = ()) -> "SdfElement":
        """Return the root of a file, an <sdf> element."""
        try:
            text = read_text(path)
        except (OSError, UnicodeDecodeError) as error:
            raise WorldError(f"cannot read {path}: {error}") from error
        return cls.parse(text, path, includers)

    @classmethod
    def parse(cls, text: str, source: Path, includers: tuple[Path, ...] = ()) -> "SdfElement":
        """Return the root of a text, an <sdf> element; plain paths are relative to the source."""
        try:
            root = parse_xml(text, str(source))
        except XmlError as error:
            raise WorldError(str(error)) from error
        read = cls(root, source, includers=includers)
        if read.tag != "sdf":
            raise read.error("is not SDF; the root element must be <sdf>")
        return read

    @property
    def tag(self) -> str:
        """The element's name."""
        return written_name(self._element)

    @property
    def line(self) -> int:
        """The element's line in its file."""
        return int(self._element.sourceline or 0)

    @property
    def label(self) -> str:
        """The element's name in messages: "link 'can'", or "<box> of link 'can'"."""
        name = self.name
        if name:
            return f"{self.tag} '{name}'"
        return f"<{self.tag}> of {self._owner}" if self._owner else f"<{self.tag}>"

    @property
    def file_label(self) -> str:
        """The file's name in messages, with its folder if the name is the usual `model.sdf`."""
        path = self.source
        return f"{path.parent.name}/{path.name}" if path.name == MODEL_FILE else path.name

    @property
    def name(self) -> str:
        """The attribute `name`, "" if there is none."""
        return self.attribute("name")

    def attribute(self, key: str) -> str:
        """Return an attribute without surrounding blanks, "" if there is none."""
        self._read_attributes.add(key)
        return str(self._element.get(key, "")).strip()

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

    def children(self, tag: str) -> "list[SdfElement]":
        """Return the children with this tag."""
        if tag not in self._children:
            self._children[tag] = self.peek_children(tag)
        return self._children[tag]

    def peek_children(self, tag: str) -> "list[SdfElement]":
        """Return the children with this tag without marking them as read."""
        return [
            SdfElement(child, self.source, self.label if self.name else self._owner, self.includers)
            for child in self._element.iterchildren("*")
            if written_name(child) == tag
        ]

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
        return default if child is None else child._text()

    def flag(self, tag: str) -> bool:
        """Return a child's text as a boolean; False if there is no such child."""
        child = self.child(tag)
        if child is None:
            return False
        if child._text().lower() not in _BOOLEANS:
            raise child.error(f"has '{child._text()}', which is neither true nor false")
        return _BOOLEANS[child._text().lower()]

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
        return self.required(tag)._numbers(count)

    def color(self, tag: str, default: Color | None = None) -> Color:
        """Return the colour of a child, which must exist unless there is a default.

        The alpha value is 1 by default.
        """
        if self.child(tag) is None and default is not None:
            return default
        r, g, b, a = (*self.required(tag)._numbers(3, 4), 1.0)[:4]
        return r, g, b, a

    def pose(self) -> SdfPose:
        """Return the pose in this element's <pose>, or no displacement."""
        pose = self.child("pose")
        if pose is None:
            return SdfPose(np.eye(4))
        matrix = pose._transform() if pose._text() else np.eye(4)
        return SdfPose(matrix, pose.attribute("relative_to"))

    def _transform(self) -> NDArray[np.float64]:
        """Return the transform (4, 4) that a <pose> holds."""
        match self.attribute("rotation_format"):
            case "" | "euler_rpy":
                x, y, z, *rpy = self._numbers(6)
                if self.boolean("degrees"):
                    rpy = [math.radians(angle) for angle in rpy]
                return transform(rotation_from_rpy(rpy), (x, y, z))
            case "quat_xyzw":
                x, y, z, *quaternion = self._numbers(7)
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
        for key, value in self._element.attrib.items():
            name = str(key)
            if (
                value.strip()
                and name[0] != "{"
                and name not in self._read_attributes | IGNORED_ATTRIBUTES
            ):
                yield Unread(self, BuildOutcome.DROPPED, NOT_SIMULATED, name)
        for child in self._element.iterchildren("*"):
            if written_name(child) not in self._children:
                attributes = {str(key): str(value) for key, value in child.attrib.items()}
                outcome = unread_outcome(written_name(child), self.tag, attributes)
                if outcome:
                    owner = self.label if self.name else self._owner
                    yield Unread(SdfElement(child, self.source, owner), *outcome)
        for children in self._children.values():
            for child in children:
                yield from child.unread()

    def _text(self) -> str:
        return str(self._element.text or "").strip()

    def _numbers(self, *counts: int) -> tuple[float, ...]:
        words = self._text().split()
        if len(words) not in counts:
            wanted = " or ".join(map(str, counts))
            raise self.error(f"has '{' '.join(words)}': {len(words)} values, not {wanted}")
        for word in words:
            if not (_NUMBER.fullmatch(word) and math.isfinite(float(word))):
                raise self.error(f"has '{word}', which is not a finite number")
        return tuple(float(word) for word in words)


@dataclass(frozen=True, slots=True)
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
        element = self.element
        return (
            f"{self.key}='{element.attribute(self.key)}' of {element.label}"
            if self.key
            else (element.label)
        )


def unread_findings(read: Iterable[SdfElement]) -> Iterator[Finding]:
    """Yield a finding for each kind of unread element and attribute in each file."""
    alike: dict[tuple[Path, str, str, BuildOutcome], list[Unread]] = {}
    for root in read:
        for unread in root.unread():
            kind = (unread.element.source, unread.element.tag, unread.key, unread.outcome)
            alike.setdefault(kind, []).append(unread)
    for group in alike.values():
        first, others = group[0], len(group) - 1
        more = f" and {others} more" if others else ""
        what = f"{first.label} in {first.element.file_label}{more}"
        yield Finding(first.outcome, what, first.reason, first.element.line, len(group))
