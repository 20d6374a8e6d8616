"""Parses URDF text into a Robot.

Elements for other readers (<gazebo>, <ros2_control>, <transmission>) and unknown ones are ignored;
known ones are fully checked.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import lxml.etree as etree

from arm_description.errors import UrdfError
from arm_description.urdf.document import Description, as_document
from arm_description.urdf.element import Remark, UrdfElement, written_name
from arm_description.urdf.joint_reader import read_joint
from arm_description.urdf.link_reader import read_link, read_material, resolve_materials
from arm_description.urdf.robot import Joint, Robot
from arm_description.urdf.xml_document import is_foreign
from arm_node.names import listing

_logger = logging.getLogger(__name__)

WORLDS = {
    "mujoco": ". MuJoCo's XML is a world: world:=FILE, or world=FILE in Python",
    "sdf": ". SDF is a world or a model: world:=FILE, or arm sim spawn FILE",
}
"""What to do with other files, by their outermost element."""


def _log(remark: Remark) -> None:
    _logger.warning("%s", remark)


def ignore_remark(_remark: Remark) -> None:
    """Ignore a remark, because another reader of the same description reports it."""


def parse_urdf(
    description: Description,
    source: str = "robot_description",
    remark: Callable[[Remark], None] = _log,
) -> Robot:
    """Parse a URDF.

    Args:
        description: the URDF; a xacro file must be expanded first (`expand_xacro`). A document
            keeps the robot: the next call returns it without a second reading.
        source: name of a text in messages.
        remark: receives problems that are not errors; by default they are logged.

    Raises:
        XmlError: the text is not XML.
        UrdfError: it is not a robot; the message names source, line and element.
    """
    document = as_document(description, source)
    if document.robot is not None:
        return document.robot
    root = UrdfElement(document.root, remark)
    if document.is_wrapped:
        root.warn("is inside a <urdf>, which ROS's own parser does not accept; it is read anyway")
    _warn_of_foreign(document.root, remark)
    try:
        document.robot = _read_robot(root)
    except UrdfError as error:
        raise type(error)(f"{document.source}, {error}") from error
    return document.robot


def _warn_of_foreign(robot: etree._Element, remark: Callable[[Remark], None]) -> None:
    """Report the elements that ROS's own parser silently ignores."""
    groups: dict[str, list[int]] = {}
    for element in robot.iter("*"):
        if is_foreign(element):
            groups.setdefault(written_name(element), []).append(int(element.sourceline or 0))
    for name, lines in groups.items():
        why = (
            "was not expanded by xacro"
            if name.startswith("xacro:")
            else "has a prefix that is not declared"
        )
        others = f" (and {len(lines) - 1} more)" if len(lines) > 1 else ""
        remark(Remark(lines[0], f"<{name}>", f"{why}{others}; it is ignored"))


def _read_robot(root: UrdfElement) -> Robot:
    if root.tag != "robot":
        hint = WORLDS.get(root.tag, "")
        raise root.error(f"is not a robot; a URDF's outermost element is <robot>{hint}")
    name = root.needed_text("name")
    links = [read_link(link) for link in root.children("link")]
    return Robot(
        name=name,
        links=resolve_materials(links, map(read_material, root.children("material"))),
        joints=tuple(_read_joints(list(root.children("joint")))),
    )


def _read_joints(elements: Sequence[UrdfElement]) -> Iterator[Joint]:
    """Yield the joints; those that mimic a joint that does not exist move by themselves.

    ROS's own parser accepts them.
    """
    joints = [read_joint(element) for element in elements]
    names = [joint.name for joint in joints]
    for element, joint in zip(elements, joints, strict=True):
        if joint.mimic is None or joint.mimic.joint in names:
            yield joint
            continue
        element.named(joint.name).warn(
            f"mimics joint '{joint.mimic.joint}', which does not exist; it moves by itself. The "
            f"robot has {listing(names)}"
        )
        yield replace(joint, mimic=None)
