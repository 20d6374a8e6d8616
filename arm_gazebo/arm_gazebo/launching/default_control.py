"""Hardware and controllers for a robot that comes without, so that any URDF can be simulated.

Whoever reads the result finds what a user could have written: a `<ros2_control>` block, and the
content of a parameter file.
"""

import re
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from arm_description.robot import Robot

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


def has_hardware(urdf: str) -> bool:
    """Return whether a description has a <ros2_control> block."""
    return "<ros2_control" in _COMMENT.sub("", urdf)


def commandable_joints(robot: Robot) -> tuple[str, ...]:
    """Return the joints that can be commanded each by itself, in the document's order."""
    return tuple(j.name for j in robot.joints if j.type in COMMANDABLE and j.mimic is None)


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


def default_parameters(joints: Sequence[str]) -> Mapping[str, Any]:
    """Return the content of a parameter file: a broadcaster, a position controller for joints.

    Without joints there is no such controller: there is nothing to control.
    """
    own = {COMMANDER: {"ros__parameters": {"joints": list(joints)}}} if joints else {}
    types = {name: {"type": DEFAULT_CONTROLLERS[name]} for name in (BROADCASTER, *own)}
    return {
        "controller_manager": {"ros__parameters": {"update_rate": UPDATE_RATE_HZ, **types}},
        **own,
    }
