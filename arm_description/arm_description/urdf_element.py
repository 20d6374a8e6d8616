"""Reading one element's attributes, with errors that name the element and its line."""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import lxml.etree as etree

from arm_description.errors import UrdfError
from arm_description.robot import Pose, Vector

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Remark:
    """What is wrong with an element, but does not keep the robot from being one."""

    line: int
    element: str
    problem: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.element} {self.problem}"


class UrdfElement:
    """An XML element of a URDF, read attribute by attribute.

    Every method raises UrdfError where something needed is missing or is not what it must be.
    """

    def __init__(
        self, element: etree._Element, remark: Callable[[Remark], None], owner: str = ""
    ) -> None:
        """Wrap an element.

        Args:
            element: the XML element.
            remark: is told what is wrong with it or with its parts, and no error.
            owner: the named element that it is part of, as messages say it: "joint 'j0'".
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
        """Return the same element, which messages about it and its parts call by this name."""
        element = UrdfElement(self._element, self._remark, f"{self.tag} '{name}'")
        element._label = element._owner
        return element

    def error(self, problem: str) -> UrdfError:
        """Return an error that says where: the line, the element, what it is part of."""
        return UrdfError(f"line {self.line}: {self._label} {problem}")

    def warn(self, problem: str) -> None:
        """Tell what is wrong with the element, but does not keep the robot from being one."""
        self._remark(Remark(self.line, self._label, problem))

    def children(self, tag: str) -> Iterator["UrdfElement"]:
        """Yield the children with this tag."""
        for child in self._element:
            if written_name(child) == tag:
                yield UrdfElement(child, self._remark, self._owner)

    def child(self, tag: str) -> "UrdfElement | None":
        """Return the first child with this tag, or None; a second one is warned about."""
        found = list(self.children(tag))
        if len(found) > 1:
            found[1].warn(f"is the second one; the one in line {found[0].line} counts")
        return found[0] if found else None

    def needed_child(self, tag: str) -> "UrdfElement":
        """Return the first child with this tag, which must be there."""
        child = self.child(tag)
        if child is None:
            raise self.error(f"needs a <{tag}>")
        return child

    def text(self, attribute: str, default: str) -> str:
        """Return an attribute without blanks around it, or a default."""
        return str(self._element.get(attribute, default)).strip()

    def needed_text(self, attribute: str) -> str:
        """Return an attribute that must be there and not be empty."""
        value = self.text(attribute, "")
        if not value:
            raise self.error(f"needs the attribute '{attribute}'")
        return value

    def number(self, attribute: str, default: float | None = None) -> float:
        """Return a finite number; without a default it must be there."""
        if default is not None and self._element.get(attribute) is None:
            return default
        return self._number(attribute, self.needed_text(attribute))

    def size(self, attribute: str) -> float:
        """Return a number that must be there and not be negative."""
        value = self.number(attribute)
        if value < 0.0:
            raise self.error(f"has {attribute}={value:g}; it must not be negative")
        return value

    def numbers(self, attribute: str, count: int) -> tuple[float, ...]:
        """Return an attribute's numbers, parted by blanks, which must be there."""
        words = self.needed_text(attribute).split()
        if len(words) != count:
            raise self.error(
                f"has {attribute}='{' '.join(words)}': {len(words)} values, not {count}"
            )
        return tuple(self._number(attribute, word) for word in words)

    def vector(self, attribute: str, default: Vector | None = None) -> Vector:
        """Return three numbers; without a default they must be there."""
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
        return Pose(origin.vector("xyz", zero), origin.vector("rpy", zero))

    def _number(self, attribute: str, word: str) -> float:
        # float() would also take "nan", "1_000" and digits of other scripts.
        value = float(word) if _NUMBER.fullmatch(word) else math.nan
        if not math.isfinite(value):
            raise self.error(f"has {attribute}='{word}', which is not a finite number")
        return value


def written_name(element: etree._Element) -> str:
    """Return an element's name as it is written, a prefix included; empty for no element.

    A prefix makes it another's element: <x:link> is no link, whatever x stands for.
    """
    tag = element.tag
    if not isinstance(tag, str):
        return ""
    name = tag.rpartition("}")[2]
    return f"{element.prefix}:{name}" if element.prefix else name
