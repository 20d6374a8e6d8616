"""Reads the joints of a URDF, SDF or COLLADA document for joint_state_publisher.

Like ROS 2's node of that name, it reads only joints: the links need not form a tree, so there may
be several roots.
"""

import logging
import math
from collections.abc import Iterable, Iterator

import lxml.etree as etree

from arm_description.errors import UrdfError
from arm_description.urdf.element import Remark, UrdfElement
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.parser import read_joint
from arm_description.urdf.robot import Joint, JointLimit
from arm_description.urdf.xml_document import parse_xml

TOPIC = "robot_description"
"""The name of the document in messages."""
COLLADA_VERSION = (1, 5)
"""The first version of COLLADA with joints."""
NON_SCALAR_TYPES = ("gearbox", "revolute2", "ball", "screw", "universal", "fixed")
"""SDF joint types with no position, several positions, or a coupling to another joint."""

_logger = logging.getLogger(__name__)


def read_joints(text: str) -> tuple[Joint, ...]:
    """Return the joints in document order; those of SDF and COLLADA have no frames.

    Raises:
        XmlError: the text is not XML.
        UrdfError: the document does not describe a robot, or a joint lacks a limit.
    """
    root = parse_xml(text, TOPIC)
    readers = {"sdf": _sdf_joints, "COLLADA": _collada_joints}
    read = readers.get(str(root.tag), _urdf_joints)
    try:
        return tuple(read(root))
    except UrdfError as error:
        raise UrdfError(f"{TOPIC}, {error}") from error


def _urdf_joints(root: etree._Element) -> Iterator[Joint]:
    robot = UrdfElement(_first(root, "robot", 'URDF must have a "robot" tag'), _log)
    return map(read_joint, robot.children("joint"))


def _log(remark: Remark) -> None:
    _logger.warning("%s", remark)


def _sdf_joints(root: etree._Element) -> Iterator[Joint]:
    model = _first(root, "model", 'SDF must have a "model" tag')
    for element in model.iterchildren("joint"):
        kind, name = element.get("type", ""), element.get("name", "")
        if kind in NON_SCALAR_TYPES:
            continue
        if kind == "continuous":
            yield _joint(name, -math.inf, math.inf)
        else:
            limit = _first(
                element, "limit", f'Limits must be specified for joint "{name}" of type "{kind}"'
            )
            yield _joint(name, *_bounds(limit, ("lower", "upper"), name, kind))


def _collada_joints(root: etree._Element) -> Iterator[Joint]:
    _check_version(root)
    model = _first(root, "kinematics_model", 'COLLADA must have a "kinematics_model" tag')
    technique = _first(model, "technique_common", 'COLLADA must have a "technique_common" tag')
    for element in technique.iterchildren("joint"):
        revolute = next(element.iter("revolute"), None)
        if revolute is None:
            continue
        name = element.get("name", "")
        limits = _first(
            revolute, "limits", f'Limits must be specified for joint "{name}" of type "revolute"'
        )
        lower, upper = _bounds(limits, ("min", "max"), name, "revolute")
        if lower != upper:  # Otherwise it is fixed.
            yield _joint(name, math.radians(lower), math.radians(upper))


def _check_version(root: etree._Element) -> None:
    version = root.get("version")
    if version is None:
        raise _error(root, "COLLADA must have a version tag")
    try:
        numbers = tuple(int(part) for part in version.split(".")[:2])
    except ValueError:
        numbers = ()
    if numbers < COLLADA_VERSION:
        raise _error(root, "COLLADA must be at least version 1.5.0")


def _bounds(
    limit: etree._Element, names: tuple[str, str], joint: str, kind: str
) -> tuple[float, float]:
    lower, upper = (_bound(limit, name, f'joint "{joint}" of type "{kind}"') for name in names)
    return lower, upper


def _bound(limit: etree._Element, name: str, of_joint: str) -> float:
    element = _first(limit, name, f'"{name}" limit must be specified for {of_joint}')
    try:
        value = float((element.text or "").strip())
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise _error(element, f'"{name}" limit must be a float for {of_joint}')
    return value


def _joint(name: str, lower: float, upper: float) -> Joint:
    endless = math.isinf(lower) and math.isinf(upper)
    return Joint(
        name=name,
        type=JointType.CONTINUOUS if endless else JointType.REVOLUTE,
        parent="",
        child="",
        limit=JointLimit(lower, upper, math.inf, math.inf),
    )


def _first(parent: etree._Element, tag: str, problem: str) -> etree._Element:
    found: Iterable[etree._Element] = parent.iter(tag)
    element = next(iter(found), None)
    if element is None:
        raise _error(parent, problem)
    return element


def _error(element: etree._Element, problem: str) -> UrdfError:
    return UrdfError(f"line {element.sourceline or 0}: {problem}")
