"""URDF text to a Robot.

What belongs to others (<gazebo>, <ros2_control>, <transmission>) and what is unknown is passed
over; what is known is checked to the last number.
"""

import logging
from collections.abc import Callable

from arm_description.errors import UrdfError
from arm_description.robot import Robot
from arm_description.urdf_element import Remark, UrdfElement
from arm_description.urdf_joint import read_joint
from arm_description.urdf_link import read_link, read_material, resolve_materials
from arm_description.xml_document import parse_xml

_logger = logging.getLogger(__name__)


def _log(remark: Remark) -> None:
    _logger.warning("%s", remark)


def parse_urdf(
    text: str, source: str = "robot_description", remark: Callable[[Remark], None] = _log
) -> Robot:
    """Parse a URDF.

    Args:
        text: the URDF; a xacro file must be expanded first (`expand_xacro`).
        source: what the text is called in messages.
        remark: is told what is wrong but no error; by default it is logged.

    Raises:
        XmlError: the text is not XML.
        UrdfError: it is not a robot; the message names source, line and element.
    """
    root = UrdfElement(parse_xml(text, source), remark)
    try:
        return _read_robot(root)
    except UrdfError as error:
        raise type(error)(f"{source}, {error}") from error


def _read_robot(root: UrdfElement) -> Robot:
    if root.tag != "robot":
        raise root.error("is not a robot; a URDF's outermost element is <robot>")
    name = root.needed_text("name")
    links = [read_link(link) for link in root.children("link")]
    return Robot(
        name=name,
        links=resolve_materials(links, map(read_material, root.children("material"))),
        joints=tuple(read_joint(joint) for joint in root.children("joint")),
    )
