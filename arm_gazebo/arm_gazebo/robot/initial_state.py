"""The positions of the joints when the simulation starts."""

import math
from collections.abc import Mapping, Sequence

from arm_control.hardware.info import HardwareInfo
from arm_description.urdf.mimic import Mimic
from arm_description.urdf.robot import Joint, Robot
from arm_gazebo.build_report import BuildReport


def initial_positions(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    follow: Mapping[str, Mimic],
    report: BuildReport,
) -> dict[str, float]:
    """Return the starting position of every joint with one degree of freedom, in rad or m.

    It is the `initial_value` of the hardware's position interface, or else 0, clamped to the
    joint's limits. A mimic joint starts where its leader puts it.
    """
    given = _given_positions(hardware)
    positions = {
        joint.name: _within_limits(joint, given, report)
        for joint in robot.joints
        if joint.type.is_scalar
    }
    for name, rule in follow.items():
        positions[name] = rule.position(positions[rule.joint])
    return positions


def _given_positions(hardware: Sequence[HardwareInfo]) -> dict[str, float]:
    return {
        joint.name: interface.initial_value
        for component in hardware
        for joint in component.joints
        # The state interface takes precedence over the command interface.
        for interface in (*joint.command_interfaces, *joint.state_interfaces)
        if interface.name == "position" and interface.initial_value is not None
    }


def _within_limits(joint: Joint, given: Mapping[str, float], report: BuildReport) -> float:
    wanted = given.get(joint.name, 0.0)
    if joint.limit is None or joint.mimic is not None:
        return wanted
    position = min(max(wanted, joint.limit.lower), joint.limit.upper)
    if not math.isclose(position, wanted, abs_tol=1e-9):
        source = "its initial_value" if joint.name in given else "its zero"
        report.repair(
            f"joint '{joint.name}'",
            f"{source} of {wanted:g} is outside its limits of {joint.limit.lower:g} and "
            f"{joint.limit.upper:g}; it starts at {position:g}",
            joint.line,
        )
    return position
