"""Reads an element's attributes, with errors that name the element and its line."""

import math
from collections.abc import Callable, Iterator

from arm_description.errors import UrdfError
from arm_description.urdf.robot import Pose, Vector
from arm_description.urdf.xml_document import XmlElement
from arm_node.frozen import frozen

NAMED = ("link", "joint")
"""Elements whose names messages use."""
QUATERNION, QUATERNION_VERSIONS = "quat_xyzw", ("1.1", "1.2")
_ZERO: Vector = (0.0, 0.0, 0.0)


@frozen
class Remark:
    """A problem of an element that does not make the description invalid."""

    line: int
    element: str
    problem: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.element} {self.problem}"


class UrdfElement(XmlElement[Callable[[Remark], None]]):
    """An element of a URDF, read attribute by attribute.

    Every method raises UrdfError if a required value is missing or invalid; `home` receives
    problems that are not errors.
    """

    __slots__ = ()

    @property
    def name(self) -> str:
        """The name of a link or a joint, "" for other elements."""
        return self.text("name") if self.tag in NAMED else ""

    def error(self, problem: str) -> UrdfError:
        """Return an error that names the line, the element and its owner."""
        return UrdfError(f"line {self.line}: {self.label} {problem}")

    def warn(self, problem: str) -> None:
        """Report a problem of the element that is not an error."""
        self.home(Remark(self.line, self.label, problem))

    def children(self, *tags: str) -> "Iterator[UrdfElement]":
        """Yield the children with one of these tags, in document order."""
        return (child for child in self.elements if child.tag in tags)

    def child(self, tag: str) -> "UrdfElement | None":
        """Return the first child with this tag, or None; warn of a second one."""
        found = None
        for child in self.elements:
            if child.tag == tag and found is None:
                found = child
            elif child.tag == tag and found is not None:
                child.warn(f"is the second one; the one in line {found.line} is used")
                break
        return found

    def needed_child(self, tag: str) -> "UrdfElement":
        """Return the first child with this tag, which must exist."""
        child = self.child(tag)
        if child is None:
            raise self.error(f"needs a <{tag}>")
        return child

    def text(self, attribute: str, default: str = "") -> str:
        """Return an attribute without surrounding blanks, or a default."""
        return self.attributes.get(attribute, default).strip()

    def needed_text(self, attribute: str) -> str:
        """Return an attribute, which must exist and not be empty."""
        value = self.attributes.get(attribute, "").strip()
        if not value:
            raise self.error(f"needs the attribute '{attribute}'")
        return value

    def number(self, attribute: str, default: float | None = None) -> float:
        """Return a finite number; without a default it must exist."""
        if default is not None and attribute not in self.attributes:
            return default
        return self.number_of(self.needed_text(attribute), f"{attribute}=")

    def size(self, attribute: str) -> float:
        """Return a number, which must exist and not be negative."""
        value = self.number(attribute)
        if value < 0.0:
            raise self.error(f"has {attribute}={value:g}; it must not be negative")
        return value

    def numbers(self, attribute: str, count: int) -> tuple[float, ...]:
        """Return an attribute's numbers, separated by blanks, which must exist."""
        return self.numbers_of(self.needed_text(attribute), (count,), f"{attribute}=")

    def vector(self, attribute: str, default: Vector | None = None) -> Vector:
        """Return three numbers; without a default they must exist."""
        if default is not None and attribute not in self.attributes:
            return default
        x, y, z = self.numbers(attribute, 3)
        return x, y, z

    def origin(self) -> Pose:
        """Return the pose in this element's <origin>, or no displacement."""
        origin = self.child("origin")
        if origin is None:
            return Pose()
        if QUATERNION in origin.attributes and origin.version not in QUATERNION_VERSIONS:
            origin.warn(
                f"has {QUATERNION}, which is ignored in URDF {origin.version}; it needs "
                f'<robot version="{QUATERNION_VERSIONS[0]}">'
            )
        return origin.pose()

    @property
    def version(self) -> str:
        """The version of URDF that the robot is written in."""
        robot = self.parent
        while robot is not None and robot.tag != "robot":
            robot = robot.parent
        return robot.get("version", "1.0") if robot else "1.0"

    def pose(self) -> Pose:
        """Return the pose that an <origin> holds."""
        if QUATERNION in self.attributes and self.version in QUATERNION_VERSIONS:
            rpy = self._quaternion()
        else:
            rpy = self.vector("rpy", _ZERO)
        return Pose(self.vector("xyz", _ZERO), rpy)

    def _quaternion(self) -> Vector:
        """Return the rotation of a quat_xyzw, which URDF has since version 1.1, as rpy."""
        if "rpy" in self.attributes:
            raise self.error(f"has both rpy and {QUATERNION}")
        # Imported here: the launcher needs NumPy for nothing else.
        import numpy as np

        from arm_description.transforms import rotation_from_quaternion, rpy_from_rotation

        quaternion = np.array(self.numbers(QUATERNION, 4))
        length = math.hypot(*quaternion)  # The sum of squares may overflow.
        if not 0.0 < length < math.inf:
            raise self.error(f"has a {QUATERNION} that is no rotation")
        return rpy_from_rotation(rotation_from_quaternion(quaternion / length))
