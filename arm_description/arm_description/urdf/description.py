"""A robot's description, parsed once: its parts for all readers, and what they have read."""

from collections.abc import Callable
from typing import Any, TypeVar

from arm_description.urdf.element import Remark, UrdfElement
from arm_description.urdf.xml_document import finite_number

_INITIAL_VALUE = ("command_interface", "state_interface")
ReadT = TypeVar("ReadT")


class RobotDescription:
    """A URDF: its text, its elements with their lines, and what has been read of it.

    Threads may share it once it has been read.

    Attributes:
        text: the URDF.
        source: the name of the text in messages.
        root: the <robot> element, or the outermost element if that is another one.
        remarks: problems that are no errors, of what has been read since they were last reported.
        links: its <link> elements, as all parts in document order.
        joints: its <joint> elements.
        materials: its own <material> elements, without those of visuals.
        ros2_control: its <ros2_control> blocks.
        gazebo: its <gazebo> elements.
    """

    def __init__(self, text: str, source: str = "robot_description") -> None:
        """Parse the text.

        Raises:
            XmlError: the text is not XML.
        """
        self.text = text
        self.source = source
        self.remarks: list[Remark] = []
        self.root = UrdfElement.parse(text, source, self.remarks.append)
        parts: dict[str, list[UrdfElement]] = {}
        for element in self.root.elements:
            parts.setdefault(element.tag, []).append(element)
        self.links = tuple(parts.get("link", ()))
        self.joints = tuple(parts.get("joint", ()))
        self.materials = tuple(parts.get("material", ()))
        self.ros2_control = tuple(parts.get("ros2_control", ()))
        self.gazebo = tuple(parts.get("gazebo", ()))
        self._read: dict[Callable[[RobotDescription], Any], Any] = {}

    @property
    def is_wrapped(self) -> bool:
        """Whether the <robot> is the only child of a <urdf>."""
        return self.root.parent is not None

    @property
    def sensors(self) -> list[tuple[str, UrdfElement]]:
        """The link or joint and the <sensor> element of each sensor.

        As in Gazebo, sensors of missing links and joints are skipped: a xacro condition that leaves
        out a link often forgets its tags. `parse_gazebo_tags` reports them.
        """
        known = {part.name for part in (*self.links, *self.joints)} - {""}
        return [
            (reference, sensor)
            for gazebo in self.gazebo
            if (reference := gazebo.text("reference")) in known
            for sensor in gazebo.children("sensor")
        ]

    def read(self, reader: "Callable[[RobotDescription], ReadT]") -> ReadT:
        """Return what a reader makes of the description; each reader reads it only once."""
        if reader not in self._read:
            self._read[reader] = reader(self)
        return self._read[reader]

    def initial_values(self) -> dict[str, float]:
        """Return the initial_value of joints' position interfaces, rad or m; omit other joints.

        A state interface's value takes precedence over a command interface's.
        """
        values: dict[str, float] = {}
        blocks = [element for element in self.root.inside() if element.tag == "ros2_control"]
        for kind in _INITIAL_VALUE:
            for joint in (joint for block in blocks for joint in block.children("joint")):
                for interface in joint.children(kind):
                    for parameter in interface.children("param"):
                        names = interface.get("name"), parameter.get("name")
                        value = finite_number(parameter.content)
                        if names == ("position", "initial_value") and value == value:
                            values[joint.get("name")] = value
        return values


Description = str | RobotDescription
"""The argument of functions that read a description: its text, or the description, parsed once."""


def as_description(description: Description, source: str = "robot_description") -> RobotDescription:
    """Return a description; parse it if it is a text.

    Raises:
        XmlError: the text is not XML.
    """
    if isinstance(description, RobotDescription):
        return description
    return RobotDescription(description, source)


def text_of(description: Description) -> str:
    """Return the text of a description."""
    return description.text if isinstance(description, RobotDescription) else description
