"""Reads an element's attributes, with errors that name the element and its line."""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import lxml.etree as etree
import numpy as np

from arm_description.errors import UrdfError
from arm_description.transforms import rotation_from_quaternion, rpy_from_rotation
from arm_description.urdf.robot import Pose, Vector

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
QUATERNION, QUATERNION_VERSIONS = "quat_xyzw", ("1.1", "1.2")


@dataclass(frozen=True, slots=True)
class Remark:
    """A problem of an element that does not make the description invalid."""

    line: int
    element: str
    problem: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.element} {self.problem}"


class UrdfElement:
    """An XML element of a URDF, read attribute by attribute.

    Every method raises UrdfError if a required value is missing or invalid.
    """

    def __init__(
        self, element: etree._Element, remark: Callable[[Remark], None], owner: str = ""
    ) -> None:
        """Wrap an element.

        Args:
            element: the XML element.
            remark: receives problems that are not errors.
            owner: the named element that it is part of, for messages: "joint 'j0'".
        """
        self._element = element
        self._remark = remark
        self._owner = owner
        self._label = f"<{self.tag}> of {owner}" if owner else f"<{self.tag}>"

    @property
    def tag(self) -> str:
        """The element's name."""
        return written_name(self._element)

    @property
    def line(self) -> int:
        """The element's line in the text."""
        return int(self._element.sourceline or 0)

    def named(self, name: str) -> "UrdfElement":
        """Return the same element with this name for messages about it and its parts."""
        element = UrdfElement(self._element, self._remark, f"{self.tag} '{name}'")
        element._label = element._owner
        return element

    def error(self, problem: str) -> UrdfError:
        """Return an error that names the line, the element and its owner."""
        return UrdfError(f"line {self.line}: {self._label} {problem}")

    def warn(self, problem: str) -> None:
        """Report a problem of the element that is not an error."""
        self._remark(Remark(self.line, self._label, problem))

    def children(self, *tags: str) -> Iterator["UrdfElement"]:
        """Yield the children with one of these tags, in document order."""
        for child in self._element:
            if written_name(child) in tags:
                yield UrdfElement(child, self._remark, self._owner)

    def child(self, tag: str) -> "UrdfElement | None":
        """Return the first child with this tag, or None; warn of a second one."""
        found = list(self.children(tag))
        if len(found) > 1:
            found[1].warn(f"is the second one; the one in line {found[0].line} is used")
        return found[0] if found else None

    def needed_child(self, tag: str) -> "UrdfElement":
        """Return the first child with this tag, which must exist."""
        child = self.child(tag)
        if child is None:
            raise self.error(f"needs a <{tag}>")
        return child

    def text(self, attribute: str, default: str) -> str:
        """Return an attribute without surrounding blanks, or a default."""
        return str(self._element.get(attribute, default)).strip()

    def needed_text(self, attribute: str) -> str:
        """Return an attribute, which must exist and not be empty."""
        value = self.text(attribute, "")
        if not value:
            raise self.error(f"needs the attribute '{attribute}'")
        return value

    def number(self, attribute: str, default: float | None = None) -> float:
        """Return a finite number; without a default it must exist."""
        if default is not None and self._element.get(attribute) is None:
            return default
        return self._number(attribute, self.needed_text(attribute))

    def size(self, attribute: str) -> float:
        """Return a number, which must exist and not be negative."""
        value = self.number(attribute)
        if value < 0.0:
            raise self.error(f"has {attribute}={value:g}; it must not be negative")
        return value

    def numbers(self, attribute: str, count: int) -> tuple[float, ...]:
        """Return an attribute's numbers, separated by blanks, which must exist."""
        words = self.needed_text(attribute).split()
        if len(words) != count:
            raise self.error(
                f"has {attribute}='{' '.join(words)}': {len(words)} values, not {count}"
            )
        return tuple(self._number(attribute, word) for word in words)

    def vector(self, attribute: str, default: Vector | None = None) -> Vector:
        """Return three numbers; without a default they must exist."""
        if default is not None and self._element.get(attribute) is None:
            return default
        x, y, z = self.numbers(attribute, 3)
        return x, y, z

    def origin(self) -> Pose:
        """Return the pose in this element's <origin>, or no displacement."""
        origin = self.child("origin")
        if origin is None:
            return Pose()
        zero = (0.0, 0.0, 0.0)
        rpy = origin._quaternion() or origin.vector("rpy", zero)
        return Pose(origin.vector("xyz", zero), rpy)

    def _quaternion(self) -> Vector | None:
        """Return the rotation of a quat_xyzw, which URDF has since version 1.1, as rpy."""
        if self._element.get(QUATERNION) is None:
            return None
        version = next(self._element.iterancestors("robot")).get("version", "1.0")
        if version not in QUATERNION_VERSIONS:
            self.warn(
                f"has {QUATERNION}, which is ignored in URDF {version}; it needs "
                f'<robot version="{QUATERNION_VERSIONS[0]}">'
            )
            return None
        if self._element.get("rpy") is not None:
            raise self.error(f"has both rpy and {QUATERNION}")
        quaternion = np.array(self.numbers(QUATERNION, 4))
        length = math.hypot(*quaternion)  # The sum of squares may overflow.
        if not 0.0 < length < math.inf:
            raise self.error(f"has a {QUATERNION} that is no rotation")
        return rpy_from_rotation(rotation_from_quaternion(quaternion / length))

    def _number(self, attribute: str, word: str) -> float:
        # float() would also accept "nan", "1_000" and digits of other scripts.
        value = float(word) if _NUMBER.fullmatch(word) else math.nan
        if not math.isfinite(value):
            raise self.error(f"has {attribute}='{word}', which is not a finite number")
        return value


def written_name(element: etree._Element) -> str:
    """Return an element's name as written, including a prefix; empty for a comment.

    An element with a prefix is not a URDF element: <x:link> is not a link, whatever x stands for.
    """
    tag = element.tag
    if not isinstance(tag, str):
        return ""
    name = tag.rpartition("}")[2]
    return f"{element.prefix}:{name}" if element.prefix else name
