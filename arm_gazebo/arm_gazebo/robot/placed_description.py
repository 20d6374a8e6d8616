"""The description of a robot that stands somewhere in a world which it shares with others."""

from collections.abc import Sequence

import lxml.etree as etree
import numpy as np

from arm_description.robot import Pose, Robot
from arm_description.transforms import rpy_from_rotation
from arm_description.urdf import parse_urdf
from arm_description.xml_document import parse_xml
from arm_gazebo.free_name import free_name
from arm_gazebo.robot.body_tree import WORLD_LINK


def placed(urdf: str, pose: Sequence[float]) -> str:
    """Return the description with its root fixed to the link "world", where the pose says.

    For the state publisher, so that /tf has the robots of one world beside each other. Where a
    link below the root is called "world", the one above the root is "ROOT_world".

    Args:
        urdf: of a robot whose root stays where it is.
        pose: of the root in the world, x y z roll pitch yaw in m and rad; () for its own.

    Raises:
        DescriptionError: the description is none.
    """
    x, y, z, roll, pitch, yaw = pose or (0.0,) * 6
    place = Pose((x, y, z), (roll, pitch, yaw))
    robot = parse_urdf(urdf)
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
    return etree.tostring(document, encoding="unicode")


def _world_of(robot: Robot) -> str:
    """Return a name for the link to add: with the root's, no two robots of one world share it."""
    links = {link.name for link in robot.links}
    if WORLD_LINK not in links:
        return WORLD_LINK
    return free_name(f"{robot.root}_{WORLD_LINK}", links)


def _set_origin(joint: etree._Element, matrix: np.ndarray) -> None:
    origin = joint.find("origin")
    if origin is None:
        origin = etree.SubElement(joint, "origin")
    origin.set("xyz", " ".join(map(repr, matrix[:3, 3].tolist())))
    origin.set("rpy", " ".join(map(repr, rpy_from_rotation(matrix[:3, :3]))))
