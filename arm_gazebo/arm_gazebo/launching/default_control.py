"""Hardware and controllers for a robot that comes without, so that any URDF can be simulated.

Whoever reads the result finds what a user could have written: a `<ros2_control>` block, and the
content of a parameter file.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from arm_description.robot import Robot

if TYPE_CHECKING:
    from arm_control.hardware_info import HardwareInfo

BROADCASTER = "joint_state_broadcaster"
COMMANDER = "position_controller"
DEFAULT_CONTROLLERS = {
    BROADCASTER: "joint_state_broadcaster/JointStateBroadcaster",
    COMMANDER: "position_controllers/JointGroupPositionController",
}
UPDATE_RATE_HZ = 100
COMMANDABLE = ("revolute", "continuous", "prismatic")
INTERFACES = ("position", "velocity", "effort")
PLUGIN = "arm_gazebo/SimulatedHardware"

_COMMENT = re.compile("<!--.*?-->", re.DOTALL)
_END = re.compile(r"</robot\s*>(?!.*</robot\s*>)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class HardwareJoints:
    """What the hardware of a robot does with its joints that move.

    Attributes:
        shown: those that it tells a state of.
        positioned: those that it commands by position, each by itself.
        driven_otherwise: those that it commands, but not by position.
    """

    shown: tuple[str, ...] = ()
    positioned: tuple[str, ...] = ()
    driven_otherwise: tuple[str, ...] = ()


def has_hardware(urdf: str) -> bool:
    """Return whether a description has a <ros2_control> block."""
    return "<ros2_control" in _COMMENT.sub("", urdf)


def commandable_joints(robot: Robot) -> tuple[str, ...]:
    """Return the joints that can be commanded each by itself, in the document's order."""
    return tuple(j.name for j in robot.joints if j.type in COMMANDABLE and j.mimic is None)


def hardware_joints(robot: Robot, hardware: "tuple[HardwareInfo, ...]") -> HardwareJoints:
    """Return the joints of a robot by what its hardware does with them.

    Many a block gives interfaces to joints that mimic others, or that are fixed, too.
    """
    moving = {joint.name for joint in robot.joints if joint.type in COMMANDABLE}
    parts = [part for component in hardware for part in component.joints]
    commands = [
        (part.name, command.name)
        for part in parts
        for command in part.command_interfaces
        if part.name in moving and part.mimic is None
    ]
    # Of dicts, because a joint has several interfaces, and may be in several blocks.
    commanded = dict.fromkeys(name for name, _ in commands)
    positioned = dict.fromkeys(name for name, by in commands if by == "position")
    return HardwareJoints(
        tuple(part.name for part in parts if part.name in moving and part.state_interfaces),
        tuple(positioned),
        tuple(name for name in commanded if name not in positioned),
    )


def with_hardware(urdf: str, robot: Robot) -> str:
    """Return the description with a block that commands every joint that can be.

    Mimicking joints only show their states. Lines of the text keep their numbers.
    """
    commanded = set(commandable_joints(robot))
    joints = "".join(
        f'<joint name="{escape(joint.name)}">'
        + "".join(f'<command_interface name="{i}"/>' for i in INTERFACES if joint.name in commanded)
        + "".join(f'<state_interface name="{i}"/>' for i in INTERFACES)
        + "</joint>"
        for joint in robot.joints
        if joint.type in COMMANDABLE
    )
    block = (
        f'<ros2_control name="simulation" type="system"><hardware><plugin>{PLUGIN}</plugin>'
        f"</hardware>{joints}</ros2_control>"
    )
    return _END.sub(lambda end: block + end.group(), urdf, count=1)


def default_controllers(joints: HardwareJoints) -> tuple[str, ...]:
    """Return which controllers to make up: none that has nothing to show, or to drive."""
    needed = {BROADCASTER: joints.shown, COMMANDER: joints.positioned}
    return tuple(name for name in DEFAULT_CONTROLLERS if needed[name])


def default_parameters(joints: HardwareJoints) -> Mapping[str, Any]:
    """Return the content of a parameter file with the `default_controllers`."""
    names = default_controllers(joints)
    types = {name: {"type": DEFAULT_CONTROLLERS[name]} for name in names}
    content: dict[str, Any] = {
        "controller_manager": {"ros__parameters": {"update_rate": UPDATE_RATE_HZ, **types}}
    }
    if COMMANDER in names:
        content[COMMANDER] = {"ros__parameters": {"joints": list(joints.positioned)}}
    return content
