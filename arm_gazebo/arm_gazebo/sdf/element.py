"""Reading one element of an SDF file; it remembers what nobody has read."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import lxml.etree as etree
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import XmlError
from arm_description.mesh_data import Color
from arm_description.transforms import rotation_from_rpy, transform
from arm_description.urdf_element import written_name
from arm_description.xml_document import parse_xml
from arm_gazebo.build_report import Finding, Outcome
from arm_gazebo.errors import WorldError

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
REASONS = {"joint": "the links of a model are one rigid body"}
"""Why an element is not read, where more can be said than that it is not."""
NEEDLESS_ATTRIBUTES = frozenset({"name", "attached_to", "canonical_link"})
"""Those that change nothing where nobody asks for them: a model is one rigid body."""
_TRUTH = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True, slots=True)
class SdfPose:
    """A pose as it is written: (4, 4) in the frame `relative_to`, "" for the usual one."""

    matrix: NDArray[np.float64]
    relative_to: str = ""


class SdfElement:
    """An element of an SDF file, whose values are mostly the texts of its children.

    Every method raises WorldError where a value is not what it must be; the message names the
    file, the line and the element.
    """

    def __init__(self, element: etree._Element, source: Path, owner: str = "") -> None:
        self._element = element
        self._owner = owner
        self._children: dict[str, list[SdfElement]] = {}
        self._asked: set[str] = set()
        self.source = source

    @classmethod
    def read(cls, path: Path) -> "SdfElement":
        """Return the root of a file, an <sdf> element."""
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise WorldError(f"cannot read {path}: {error}") from error
        return cls.parse(text, path)

    @classmethod
    def parse(cls, text: str, source: Path) -> "SdfElement":
        """Return the root of a text, an <sdf> element; plain paths start beside the source."""
        try:
            root = parse_xml(text, str(source))
        except XmlError as error:
            raise WorldError(str(error)) from error
        read = cls(root, source)
        if read.tag != "sdf":
            raise read.error("is no SDF; its root has to be <sdf>")
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
        """What messages call the element: "link 'can'", or "<box> of link 'can'"."""
        name = self.name
        if name:
            return f"{self.tag} '{name}'"
        return f"<{self.tag}> of {self._owner}" if self._owner else f"<{self.tag}>"

    @property
    def name(self) -> str:
        """The attribute `name`, "" without one."""
        return self.attribute("name")

    def attribute(self, key: str) -> str:
        """Return an attribute without blanks around it, "" where there is none."""
        self._asked.add(key)
        return str(self._element.get(key, "")).strip()

    def truth(self, key: str) -> bool:
        """Return the truth that an attribute tells, False where there is none."""
        text = self.attribute(key).lower() or "false"
        if text not in _TRUTH:
            raise self.error(f"has {key}='{text}', which is neither true nor false")
        return _TRUTH[text]

    def error(self, problem: str) -> WorldError:
        """Return an error that says where."""
        return WorldError(f"{self.source}, line {self.line}: {self.label} {problem}")

    def children(self, tag: str) -> "list[SdfElement]":
        """Return the children with this tag."""
        if tag not in self._children:
            self._children[tag] = self.aside(tag)
        return self._children[tag]

    def aside(self, tag: str) -> "list[SdfElement]":
        """Return the children with this tag, which remain unread whatever is asked of them."""
        return [
            SdfElement(child, self.source, self.label if self.name else self._owner)
            for child in self._element.iterchildren("*")
            if written_name(child) == tag
        ]

    def child(self, tag: str) -> "SdfElement | None":
        """Return the first child with this tag, or None."""
        found = self.children(tag)
        return found[0] if found else None

    def needed(self, tag: str) -> "SdfElement":
        """Return the first child with this tag, which must be there."""
        child = self.child(tag)
        if child is None:
            raise self.error(f"needs a <{tag}>")
        return child

    def at(self, *tags: str) -> "SdfElement | None":
        """Return what a path of first children leads to, or None."""
        element: SdfElement | None = self
        for tag in tags:
            element = element and element.child(tag)
        return element

    def text(self, tag: str, default: str = "") -> str:
        """Return the text of a child, or a default."""
        child = self.child(tag)
        return default if child is None else child._text()

    def flag(self, tag: str, default: bool = False) -> bool:
        """Return the truth that a child tells, or a default."""
        child = self.child(tag)
        if child is None:
            return default
        if child._text().lower() not in _TRUTH:
            raise child.error(f"has '{child._text()}', which is neither true nor false")
        return _TRUTH[child._text().lower()]

    def number(self, tag: str, default: float | None = None) -> float:
        """Return the number of a child; without a default it must be there."""
        return self.numbers(tag, 1, None if default is None else (default,))[0]

    def size(self, tag: str) -> float:
        """Return the number of a child that must be there and be above 0."""
        value = self.number(tag)
        if value <= 0:
            raise self.needed(tag).error(f"has {value:g}; it must be above 0")
        return value

    def numbers(
        self, tag: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """Return the numbers of a child; without a default it must be there."""
        child = self.child(tag)
        if child is None and default is not None:
            return default
        return self.needed(tag)._numbers(count)

    def color(self, tag: str, default: Color | None = None) -> Color:
        """Return the colour of a child, whose alpha is 1 where it is left out.

        Without a default it must be there.
        """
        if self.child(tag) is None and default is not None:
            return default
        r, g, b, a = (*self.needed(tag)._numbers(3, 4), 1.0)[:4]
        return r, g, b, a

    def pose(self) -> SdfPose:
        """Return the pose in this element's <pose>, or no displacement."""
        pose = self.child("pose")
        if pose is None:
            return SdfPose(np.eye(4))
        if pose.attribute("rotation_format") not in ("", "euler_rpy"):
            raise pose.error("has a rotation_format other than euler_rpy")
        x, y, z, *rpy = pose._numbers(6) if pose._text() else (0.0,) * 6
        if pose.truth("degrees"):
            rpy = [math.radians(angle) for angle in rpy]
        matrix = transform(rotation_from_rpy(rpy), (x, y, z))
        return SdfPose(matrix, pose.attribute("relative_to"))

    def unread(self) -> Iterator[Finding]:
        """Yield the elements and attributes that nobody has asked for, each kind once."""
        left: dict[tuple[str, str], list[SdfElement]] = {}
        for element, key in self._unread():
            left.setdefault((element.tag, key), []).append(element)
        for (tag, key), elements in left.items():
            first, others = elements[0], len(elements) - 1
            more = f" and {others} more" if others else ""
            what = f"{key}='{first.attribute(key)}' of {first.label}" if key else first.label
            reason = "it is not simulated" if key else REASONS.get(tag, "it is not simulated")
            yield Finding(
                Outcome.DROPPED, f"{what} in {self.source.name}{more}", reason, first.line
            )

    def _unread(self) -> "Iterator[tuple[SdfElement, str]]":
        """Yield each element with the attribute that is left, "" where it is left itself."""
        # Old versions write attributes without a value; "{...}" is a namespace.
        for key, value in self._element.attrib.items():
            name = str(key)
            if value.strip() and name[0] != "{" and name not in self._asked | NEEDLESS_ATTRIBUTES:
                yield self, name
        for child in self._element.iterchildren("*"):
            if written_name(child) not in self._children:
                owner = self.label if self.name else self._owner
                yield SdfElement(child, self.source, owner), ""
        for children in self._children.values():
            for child in children:
                yield from child._unread()

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
