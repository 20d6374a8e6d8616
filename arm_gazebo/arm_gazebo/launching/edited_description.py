"""Change the text of a robot's description: copies with other names, a place in a world."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import lxml.etree as etree
import numpy as np

from arm_description.transforms import rpy_from_rotation
from arm_description.urdf.description_source import source_of, with_source
from arm_description.urdf.element import NAMED, QUATERNION
from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_description.urdf.robot import Pose, Robot
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.mjcf.names import free_name

WORLD_LINK = "world"
"""The name of a root link that is the world itself, which all copies share."""
REFERENCES = ("link", "joint", "reference")
"""Attributes that name a link or a joint."""
NAMING_TEXTS = (
    *("parent", "child", "link", "joint", "joint_name", "param"),
    *("frame_id", "gz_frame_id", "ignition_frame_id", "optical_frame_id", "frameName"),
)
"""Elements whose text may be the name of a link or a joint."""
TOPIC = "topic"
"""The end of the name of elements with a sensor's topic."""


@dataclass(frozen=True, slots=True)
class DescriptionCopy:
    """A copy of a description.

    Attributes:
        name: the name of the copied robot.
        text: its URDF.
        names: new names of links and joints by their names in the original.
    """

    name: str
    text: str
    names: dict[str, str]


def copy_description(urdf: str, name: str) -> DescriptionCopy:
    """Return a description whose links and joints have the prefix NAME_, and whose robot is NAME.

    A root link `world` keeps its name. Absolute topics of sensors become relative, so that each
    copy can have its own in its namespace.

    Raises:
        XmlError: the text is not XML.
    """
    document = parse_xml(urdf)
    children = {element.get("link") for element in document.iterfind("joint/child")}
    names = {
        original: f"{name}_{original}"
        for original in _links_and_joints(document)
        if original != WORLD_LINK or original in children
    }
    document.set("name", name)
    for element in document.iter("*"):
        _rename(element, names)
    for element in document.iterfind("gazebo//*"):
        if str(element.tag).endswith(TOPIC) and element.text:
            element.text = element.text.strip().lstrip("/")
    return DescriptionCopy(name, edited_text(document, urdf), names)


def _links_and_joints(document: etree._Element) -> Iterator[str]:
    for kind in NAMED:
        yield from (str(element.get("name", "")) for element in document.iterfind(kind))


def _rename(element: etree._Element, names: dict[str, str]) -> None:
    for attribute in (*REFERENCES, *(("name",) if element.tag in NAMED else ())):
        value = element.get(attribute)
        if value in names:
            element.set(attribute, names[value])
    text = (element.text or "").strip()
    if element.tag in NAMING_TEXTS and text in names:
        element.text = names[text]


def placed(urdf: str, pose: Sequence[float]) -> str:
    """Return the description with its root fixed to the link "world" at a pose.

    The state publisher uses it, so that /tf shows the robots of one world at their places. If a
    link below the root is already called "world", the new link is called "ROOT_world".

    Args:
        urdf: description of a robot whose root does not move.
        pose: pose of the root in the world, x y z roll pitch yaw in m and rad; () for the origin.

    Raises:
        DescriptionError: the description is invalid.
    """
    x, y, z, roll, pitch, yaw = pose or (0.0,) * 6
    place = Pose((x, y, z), (roll, pitch, yaw))
    robot = parse_urdf(urdf, remark=ignore_remark)
    document = parse_xml(urdf)
    if robot.root == WORLD_LINK:
        moved = {joint.name: joint.origin for joint in robot.children(WORLD_LINK)}
        for element in document.findall("joint"):
            if element.get("name") in moved:
                _set_origin(element, place.matrix() @ moved[element.get("name")].matrix())
    else:
        world = _world_of(robot)
        etree.SubElement(document, "link", name=world)
        name = free_name(f"{world}_to_{robot.root}", {joint.name for joint in robot.joints})
        element = etree.SubElement(document, "joint", name=name, type="fixed")
        etree.SubElement(element, "parent", link=world)
        etree.SubElement(element, "child", link=robot.root)
        _set_origin(element, place.matrix())
    return edited_text(document, urdf)


def edited_text(document: etree._Element, original: str) -> str:
    """Return the text of a document, with the source that the original's text names."""
    source = source_of(original)
    text = etree.tostring(document, encoding="unicode")
    return text if source.file is None else with_source(text, source.file, source.package_path)


def _world_of(robot: Robot) -> str:
    """Return a name for the new link; it contains the root's name to be unique in the world."""
    links = {link.name for link in robot.links}
    if WORLD_LINK not in links:
        return WORLD_LINK
    return free_name(f"{robot.root}_{WORLD_LINK}", links)


def _set_origin(joint: etree._Element, matrix: np.ndarray) -> None:
    origin = joint.find("origin")
    if origin is None:
        origin = etree.SubElement(joint, "origin")
    origin.attrib.pop(QUATERNION, None)
    origin.set("xyz", " ".join(map(repr, matrix[:3, 3].tolist())))
    origin.set("rpy", " ".join(map(repr, rpy_from_rotation(matrix[:3, :3]))))
