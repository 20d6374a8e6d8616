"""Place a robot's description in a world that it shares with other robots."""

from collections.abc import Sequence

import lxml.etree as etree
import numpy as np

from arm_description.transforms import rpy_from_rotation
from arm_description.urdf.description_source import source_of, with_source
from arm_description.urdf.element import QUATERNION
from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_description.urdf.robot import Pose, Robot
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.mjcf.names import free_name
from arm_gazebo.robot.body_tree import WORLD_LINK


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
    source = source_of(urdf)
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
