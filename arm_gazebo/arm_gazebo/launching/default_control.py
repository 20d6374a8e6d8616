"""Default hardware and controllers for a robot without any, so that any URDF can be simulated.

The result is what a user could have written: a `<ros2_control>` block, and the content of a
parameter file.
"""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from arm_node.frozen import frozen

if TYPE_CHECKING:
    from arm_control.hardware.info import HardwareInfo
    from arm_description.urdf.robot import Robot

BROADCASTER = "joint_state_broadcaster"
COMMANDER = "position_controller"
TRAJECTORY = "joint_trajectory_controller"
CONTROLLER_TYPES = {
    BROADCASTER: "joint_state_broadcaster/JointStateBroadcaster",
    COMMANDER: "position_controllers/JointGroupPositionController",
    TRAJECTORY: "joint_trajectory_controller/JointTrajectoryController",
}
TRAJECTORY_PARAMETERS = {
    "command_interfaces": ["position"],
    "state_interfaces": ["position", "velocity"],
    "allow_partial_joints_goal": True,
    "interpolate_from_desired_state": True,
}
"""A motion that was planned for an arm leaves out its gripper; each starts at the last command."""
UPDATE_RATE_HZ = 100
INTERFACES = ("position", "velocity", "effort")
PLUGIN = "arm_gazebo/SimulatedHardware"

_COMMENT = re.compile("<!--.*?-->", re.DOTALL)
_END = re.compile(r"</robot\s*>(?!.*</robot\s*>)", re.DOTALL)


@frozen
class HardwareJoints:
    """The moving joints of a robot by their hardware interfaces.

    Attributes:
        observed: joints with state interfaces.
        position_commanded: joints with a position command interface.
        otherwise_commanded: joints with command interfaces, but none for position.
    """

    observed: tuple[str, ...] = ()
    position_commanded: tuple[str, ...] = ()
    otherwise_commanded: tuple[str, ...] = ()


def has_hardware(urdf: str) -> bool:
    """Return whether a description has a <ros2_control> block."""
    return "<ros2_control" in _COMMENT.sub("", urdf)


def commandable_joints(robot: "Robot") -> tuple[str, ...]:
    """Return the joints that can be commanded independently, in document order."""
    return tuple(j.name for j in robot.joints if j.type.is_scalar and j.mimic is None)


def hardware_joints(robot: "Robot", hardware: "tuple[HardwareInfo, ...]") -> HardwareJoints:
    """Return the joints of a robot by their hardware interfaces.

    Fixed joints, and commands to mimic joints, are left out; some blocks list them anyway.
    """
    moving = {joint.name for joint in robot.joints if joint.type.is_scalar}
    parts = [part for component in hardware for part in component.joints]
    commands = [
        (part.name, command.name)
        for part in parts
        for command in part.command_interfaces
        if part.name in moving and part.mimic is None
    ]
    # Dicts remove duplicates: a joint has several interfaces, and may be in several blocks.
    commanded = dict.fromkeys(name for name, _ in commands)
    by_position = dict.fromkeys(name for name, interface in commands if interface == "position")
    return HardwareJoints(
        tuple(part.name for part in parts if part.name in moving and part.state_interfaces),
        tuple(by_position),
        tuple(name for name in commanded if name not in by_position),
    )


def with_hardware(urdf: str, robot: "Robot") -> str:
    """Return the description with a block that commands every joint that can be commanded.

    Mimic joints have state interfaces only. Line numbers of the text do not change.
    """
    # Imported here, because most robots have a block of their own.
    from html import escape

    commanded = set(commandable_joints(robot))
    joints = "".join(
        f'<joint name="{escape(joint.name)}">'
        + "".join(f'<command_interface name="{i}"/>' for i in INTERFACES if joint.name in commanded)
        + "".join(f'<state_interface name="{i}"/>' for i in INTERFACES)
        + "</joint>"
        for joint in robot.joints
        if joint.type.is_scalar
    )
    block = (
        f'<ros2_control name="simulation" type="system"><hardware><plugin>{PLUGIN}</plugin>'
        f"</hardware>{joints}</ros2_control>"
    )
    return _END.sub(lambda end: block + end.group(), urdf, count=1)


def default_controllers(joints: HardwareJoints, commander: str = COMMANDER) -> tuple[str, ...]:
    """Return the default controllers that have a joint to broadcast or to command.

    `commander` is COMMANDER or TRAJECTORY, which claim the same joints.
    """
    needed = {BROADCASTER: joints.observed, commander: joints.position_commanded}
    return tuple(name for name, whose in needed.items() if whose)


def default_parameters(joints: HardwareJoints) -> Mapping[str, Any]:
    """Return the content of a parameter file with all `default_controllers`."""
    names = dict.fromkeys((*default_controllers(joints), *default_controllers(joints, TRAJECTORY)))
    types = {name: {"type": CONTROLLER_TYPES[name]} for name in names}
    content: dict[str, Any] = {
        "controller_manager": {"ros__parameters": {"update_rate": UPDATE_RATE_HZ, **types}}
    }
    commanded = {"joints": list(joints.position_commanded)}
    if joints.position_commanded:
        content[COMMANDER] = {"ros__parameters": commanded}
        content[TRAJECTORY] = {"ros__parameters": {**commanded, **TRAJECTORY_PARAMETERS}}
    return content
