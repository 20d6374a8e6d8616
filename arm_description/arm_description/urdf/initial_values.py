"""Reads the joints' initial positions from a description's <ros2_control>."""

import math

from arm_description.urdf.xml_document import parse_xml

_INTERFACES = ("command_interface", "state_interface")
_PARAMETER = "param[@name='initial_value']"


def initial_values(urdf: str) -> dict[str, float]:
    """Return the initial_value of joints' position interfaces, rad or m; omit other joints.

    A state interface's value takes precedence over a command interface's.

    Raises:
        XmlError: the text is not XML.
    """
    values: dict[str, float] = {}
    joints = parse_xml(urdf).findall(".//ros2_control/joint")
    for tag in _INTERFACES:
        for joint in joints:
            for parameter in joint.findall(f"{tag}[@name='position']/{_PARAMETER}"):
                value = _number(parameter.text)
                if math.isfinite(value):
                    values[joint.get("name", "")] = value
    return values


def _number(text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError:
        return math.nan
