"""Which joints are driven, and the actuators that drive them."""

import math
from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass

import mujoco

from arm_control.hardware_info import HardwareInfo, JointInfo
from arm_description.names import listing
from arm_description.robot import Joint, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.robot.mimic_joints import SCALAR_TYPES, Following

DEFAULT_SPEED = {"revolute": 3.0, "continuous": 3.0, "prismatic": 0.5}
"""Highest speed, in rad/s or m/s, on the way to a position, of a joint whose URDF gives none."""
BOUNDLESS = 1e9
"""A limit of speed or effort, in SI units, from which on it is none: no joint comes near it."""


@dataclass(frozen=True, slots=True)
class Drive:
    """A joint that is commanded: its bounds and where it starts, in rad or m.

    Attributes:
        joint: name.
        velocity: highest speed of a set-point on its way to a position, above 0.
        velocity_limit: highest speed at all, inf if it has no bound.
        effort: highest force or torque, inf if it has no bound.
    """

    joint: str
    velocity: float
    velocity_limit: float
    effort: float


def drives(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    follow: Iterable[Following],
    report: BuildReport,
) -> tuple[Drive, ...]:
    """Return the joints that the hardware components command, in their order.

    Raises:
        ModelError: two components command the same joint.
    """
    known = {joint.name: joint for joint in robot.joints}
    followers = {following.joint: following.leader for following in follow}
    owners: dict[str, str] = {}
    found = []
    for component in hardware:
        for info in component.joints:
            problem = _problem(info, known, followers)
            if problem:
                report.warn(f"<ros2_control> joint '{info.name}'", problem, component.line)
            elif info.command_interfaces:
                if info.name in owners:
                    raise ModelError(
                        f"joint '{info.name}' is commanded by the components "
                        f"'{owners[info.name]}' and '{component.name}'; it can have one"
                    )
                owners[info.name] = component.name
                found.append(_drive(known[info.name], report))
    if hardware:
        _name_missing(known, {i.name for c in hardware for i in c.joints} | {*followers}, report)
    return tuple(found)


def _name_missing(known: dict[str, Joint], named: Container[str], report: BuildReport) -> None:
    """Say which joints nobody moves or sees; a follower is seen where its leader is."""
    missing = [j for j in known.values() if j.type in SCALAR_TYPES and j.name not in named]
    if missing:
        many = len(missing) > 1
        report.warn(
            f"joints {listing([j.name for j in missing])}"
            if many
            else f"joint '{missing[0].name}'",
            f"no <ros2_control> block names {'them' if many else 'it'}: no drive, no joint state, "
            "no frame in /tf",
            missing[0].line,
        )


def _problem(info: JointInfo, known: dict[str, Joint], followers: dict[str, str]) -> str:
    """Return why a joint of the hardware is not driven, empty if it can be."""
    joint = known.get(info.name)
    if joint is None:
        return f"the robot has no such joint, it has {', '.join(known)}; it is left out"
    if joint.type not in SCALAR_TYPES:
        return f"a {joint.type} joint cannot be commanded; it is left out"
    if info.name in followers and info.command_interfaces:
        return (
            f"it mimics '{followers[info.name]}' and cannot be commanded besides, "
            'unless mimic="false" in its <joint> there makes it independent'
        )
    return ""


def _drive(joint: Joint, report: BuildReport) -> Drive:
    velocity = limit = joint.limit.velocity if joint.limit else 0.0
    effort = joint.limit.effort if joint.limit else 0.0
    element = f"joint '{joint.name}'"
    if not 0 < velocity < BOUNDLESS:
        velocity, limit = DEFAULT_SPEED[joint.type], math.inf
        unit = "m/s" if joint.type == "prismatic" else "rad/s"
        report.repair(
            element,
            f"it has no velocity limit; it goes to positions at up to {velocity:g} {unit}",
            joint.line,
        )
    if not 0 < effort < BOUNDLESS:
        effort = math.inf
        report.repair(
            element, "it has no effort limit; its drive is as strong as need be", joint.line
        )
    return Drive(joint.name, velocity, limit, effort)


def add_actuators(spec: mujoco.MjSpec, driven: Iterable[Drive], default: mujoco.MjsDefault) -> None:
    """Add one actuator for each driven joint, of the same name.

    Its activation integrates its control within a control period, so that a set-point moves on
    between two ticks without any Python; see `servo`. The servo sets the gains.
    """
    for drive in driven:
        actuator = spec.add_actuator(
            default,
            name=drive.joint,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            target=drive.joint,
            dyntype=mujoco.mjtDyn.mjDYN_INTEGRATOR,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
            # The force answers to this step's set-point, not to the one before.
            actearly=True,
        )
        actuator.gainprm = [0.0] * len(actuator.gainprm)
        if math.isfinite(drive.effort):
            actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
            actuator.forcerange = [-drive.effort, drive.effort]
