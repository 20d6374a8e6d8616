"""One description and the controllers of two equal arms, of which one follows the other."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import lxml.etree as etree

from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.edited_description import WORLD_LINK, copy_description, placed
from arm_gazebo.launching.real_hardware import on_hardware

LEADER, FOLLOWER = "leader", "follower"
APART_M = 0.3
"""How far each stands from the middle in the page; the real ones may stand anywhere."""
UPDATE_RATE_HZ = 200
"""A reading is one cycle old when it becomes a goal, so half the period is half the lag."""
STATES_RATE_HZ = 100
"""Rate of /joint_states, for recordings."""


@dataclass(frozen=True, slots=True)
class ArmPair:
    """Two arms.

    Attributes:
        description: URDF of both, with prefixed names.
        controllers: parameters by node.
    """

    description: str
    controllers: Mapping[str, Any]


def pair_arms(urdf: str, hardware: str, ports: Mapping[str, Mapping[str, str]]) -> ArmPair:
    """Return two arms of one kind; the leader is not powered, and moved by hand.

    `hardware` is the launch argument of that name; `ports` has the parameters of the hardware of
    LEADER and FOLLOWER.

    Raises:
        SimSettingsError: the hardware is unknown, or no joint can be commanded by position.
        DescriptionError: the description is invalid.
    """
    from arm_control.hardware.info import parse_hardware_info

    pair = etree.Element("robot", name=f"{LEADER}_{FOLLOWER}")
    etree.SubElement(pair, "link", name=WORLD_LINK)
    for name, side in ((LEADER, 1), (FOLLOWER, -1)):
        text = on_hardware(copy_description(urdf, name).text, hardware, ports[name])
        arm = parse_xml(placed(text, (0.0, side * APART_M, 0.0, 0.0, 0.0, 0.0)))
        for block in arm.findall("ros2_control"):
            block.set("name", name)
        pair.extend(each for each in arm if each.get("name") != WORLD_LINK)
    description = etree.tostring(pair, encoding="unicode")
    (follower,) = (i for i in parse_hardware_info(description) if i.name == FOLLOWER)
    joints = [
        joint.name
        for joint in follower.joints
        if joint.mimic is None and "position" in {c.name for c in joint.command_interfaces}
    ]
    if not joints:
        raise SimSettingsError("no joint of the description can be commanded by position")
    own = {
        "leader_joints": [LEADER + joint.removeprefix(FOLLOWER) for joint in joints],
        "follower_joints": joints,
    }
    manager = {
        "update_rate": UPDATE_RATE_HZ,
        "joint_state_broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
        "leader_follower": {"type": "arm_drivers/LeaderFollowerController"},
    }
    controllers = {
        "controller_manager": manager,
        "joint_state_broadcaster": {"update_rate": STATES_RATE_HZ},
        "leader_follower": own,
    }
    return ArmPair(description, {n: {"ros__parameters": p} for n, p in controllers.items()})
