"""Which joints are driven, and the actuators that drive them."""

import math
from collections.abc import Container, Iterable, Mapping, Sequence

import mujoco

from arm_control.hardware.info import HardwareInfo, JointInfo
from arm_description.urdf.robot import Joint, Mimic, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_node.frozen import frozen
from arm_node.names import listing


@frozen
class RobotJoint:
    """A joint with one degree of freedom; positions in rad or m.

    Attributes:
        name: as in the URDF.
        qpos_address: index in `data.qpos`.
        dof_address: index in `data.qvel`.
        actuator: number of its actuator in the model; None if it is not driven. Its control and
            activation are elsewhere, see `drive_slices`.
        lower: lower position limit, -inf if there is none.
        upper: upper position limit, inf if there is none.
        velocity: highest speed of a set-point that moves to a position, above 0.
        velocity_limit: velocity limit, inf if there is none.
        effort: effort limit, inf if there is none.
        initial: position at the start.
        linear: whether the joint slides; otherwise it turns.
    """

    name: str
    qpos_address: int
    dof_address: int
    actuator: int | None
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    velocity_limit: float = math.inf
    effort: float = math.inf
    initial: float = 0.0
    linear: bool = False


def drive_slices(model: mujoco.MjModel, joints: Sequence[RobotJoint]) -> tuple[slice, slice]:
    """Return where driven joints have their activations in `data.act`, and controls in `data.ctrl`.

    Neither is at the actuator's number: a world may have actuators with several controls or none.
    The actuators of the joints stand together.
    """
    first = next((joint.actuator for joint in joints if joint.actuator is not None), None)
    if first is None:
        return slice(0, 0), slice(0, 0)
    starts = int(model.actuator_actadr[first]), int(model.actuator_ctrladr[first])
    activations, controls = (slice(start, start + len(joints)) for start in starts)
    return activations, controls


UNLIMITED = 1e9
"""A speed or effort limit of this or more, in SI units, counts as no limit: no joint reaches it."""


@frozen
class Drive:
    """A commanded joint and its limits, per rad or m.

    Attributes:
        joint: name of the joint.
        velocity: highest speed of a set-point that moves to a position, above 0.
        velocity_limit: velocity limit, inf if there is none.
        effort: effort limit, inf if there is none.
    """

    joint: str
    velocity: float
    velocity_limit: float
    effort: float


def drives(
    robot: Robot,
    hardware: Sequence[HardwareInfo],
    follow: Mapping[str, Mimic],
    report: BuildReport,
) -> tuple[Drive, ...]:
    """Return the joints that the hardware components command, in order.

    Raises:
        ModelError: two components command the same joint.
    """
    known = {joint.name: joint for joint in robot.joints}
    followers = {name: rule.joint for name, rule in follow.items()}
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
                        f"'{owners[info.name]}' and '{component.name}'; only one may command it"
                    )
                owners[info.name] = component.name
                found.append(_drive(known[info.name], report))
    if hardware:
        _warn_about_unnamed_joints(
            known, {i.name for c in hardware for i in c.joints} | {*followers}, report
        )
    return tuple(found)


def _warn_about_unnamed_joints(
    known: dict[str, Joint], named: Container[str], report: BuildReport
) -> None:
    """Warn about joints without a driver or joint state; mimic joints need no entry."""
    missing = [j for j in known.values() if j.type.is_scalar and j.name not in named]
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
    """Return why a joint of the hardware is not driven; empty if it is."""
    joint = known.get(info.name)
    if joint is None:
        return f"the robot has no such joint, it has {', '.join(known)}; it is left out"
    if not joint.type.is_scalar:
        return f"a {joint.type} joint cannot be commanded; it is left out"
    if info.name in followers and info.command_interfaces:
        return (
            f"it mimics '{followers[info.name]}' and cannot be commanded; "
            'mimic="false" in its <joint> there makes it independent'
        )
    return ""


def _drive(joint: Joint, report: BuildReport) -> Drive:
    velocity = limit = joint.limit.velocity if joint.limit else 0.0
    effort = joint.limit.effort if joint.limit else 0.0
    element = f"joint '{joint.name}'"
    if not 0 < velocity < UNLIMITED:
        velocity, limit = joint.type.default_speed, math.inf
        report.repair(
            element,
            "it has no velocity limit; it moves to positions at up to "
            f"{velocity:g} {joint.type.unit}/s",
            joint.line,
        )
    if not 0 < effort < UNLIMITED:
        effort = math.inf
        report.repair(
            element, "it has no effort limit; its drive is as strong as necessary", joint.line
        )
    return Drive(joint.name, velocity, limit, effort)


def add_actuators(spec: mujoco.MjSpec, driven: Iterable[Drive], default: mujoco.MjsDefault) -> None:
    """Add one actuator for each driven joint, with the same name.

    The activation integrates the control within a control period, so that the set-point moves
    between two ticks without any Python code; see `servo`. The servo sets the gains.
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
            # The force follows this step's set-point, not that of the previous step.
            actearly=True,
        )
        actuator.gainprm = [0.0] * len(actuator.gainprm)
        if math.isfinite(drive.effort):
            actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
            actuator.forcerange = [-drive.effort, drive.effort]
