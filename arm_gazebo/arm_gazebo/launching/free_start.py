"""Starts a robot that plans where it touches neither itself nor the floor.

No motion can be planned from a state in which links are inside each other, and many arms are so
with all joints at zero: a Panda's hand is in its forearm there.
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import replace

from arm_description.urdf.description import RobotDescription
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.launching.edited_description import edited_text
from arm_gazebo.launching.robot_setup import RobotSetup

MODULE = "arm_planning.free_start"
TIMEOUT_S = 20.0
"""A robot whose meshes take longer starts at zero; `move_group` says what touches there."""


def starting_free(setup: RobotSetup) -> RobotSetup:
    """Give a robot that touches something with all joints at zero other initial values.

    Nothing changes if its description has initial values, or if it is free at zero.
    """
    if RobotDescription(setup.description).initial_values():
        return setup
    positions = _free_positions(setup)
    if not positions:
        return setup
    listed = ", ".join(f"{joint} at {value:g}" for joint, value in positions.items())
    remark = (
        "with all joints at zero the robot touches itself or the floor, and so it starts with "
        f"{listed}; an initial_value in <ros2_control> chooses another start"
    )
    description = with_initial_values(setup.description, positions)
    return replace(setup, description=description, remarks=(*setup.remarks, remark))


def _free_positions(setup: RobotSetup) -> dict[str, float]:
    """Return the positions of the joints that do not start at zero, rad or m."""
    paths = os.pathsep.join(map(str, setup.package_path))
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", MODULE, paths],
            input=setup.description,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=TIMEOUT_S,
            check=False,
            encoding="utf-8",
        )
    except subprocess.TimeoutExpired:
        return {}
    return json.loads(done.stdout) if done.returncode == 0 else {}


def with_initial_values(urdf: str, positions: Mapping[str, float]) -> str:
    """Return the description with initial values of joints' position interfaces.

    Args:
        urdf: a description without initial values.
        positions: rad or m, by joint; others are left as they are.

    Raises:
        XmlError: the text is not XML.
    """
    document = parse_xml(urdf)
    for joint in document.iterfind("ros2_control/joint"):
        for interface in joint.iterfind("state_interface[@name='position']"):
            if (value := positions.get(str(joint.get("name")))) is not None:
                parameter = interface.makeelement("param", {"name": "initial_value"})
                parameter.text = repr(value)
                interface.append(parameter)
    return edited_text(document, urdf)
