"""Add mimic joints as stiff equality constraints between joint positions."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import mujoco

from arm_control.hardware.info import HardwareInfo
from arm_description.urdf.robot import Joint, JointLimit, Mimic, Robot
from arm_gazebo.build_report import BuildReport

FITS_WITHIN = 1e-3
"""How far, in rad or m, a mimic joint may be driven past its own limit without a warning."""


def without_independent_mimics(robot: Robot, hardware: Iterable[HardwareInfo]) -> Robot:
    """Return the robot without the mimic rules that mimic="false" in the hardware disables."""
    free = {info.name for component in hardware for info in component.joints if info.mimic is None}
    joints = (replace(j, mimic=None) if j.name in free else j for j in robot.joints)
    return replace(robot, joints=tuple(joints))


def mimic_rules(robot: Robot, report: BuildReport) -> dict[str, Mimic]:
    """Return for each joint that mimics another how it follows the end of its chain."""
    found: dict[str, Mimic] = {}
    for joint in robot.joints:
        if joint.mimic is None:
            continue
        rule = robot.leader_of(joint.name)
        leader = robot.joint(rule.joint)
        if not (joint.type.is_scalar and leader.type.is_scalar):
            report.warn(
                f"joint '{joint.name}'",
                f"it is {joint.type} and mimics '{leader.name}', which is {leader.type}; "
                "only joints with one degree of freedom can; it does not follow",
                joint.line,
            )
            continue
        found[joint.name] = rule
    return found


def add_equalities(
    spec: mujoco.MjSpec,
    robot: Robot,
    follow: Mapping[str, Mimic],
    step_s: float,
    report: BuildReport,
) -> None:
    """Constrain mimic joints to their leaders.

    With MuJoCo's default equality a gripper's finger lags by 20 mrad; with this one by 1 mrad.
    """
    for name, rule in follow.items():
        equality = spec.add_equality(
            name=f"{name}_mimic",
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=name,
            name2=rule.joint,
        )
        equality.data = [rule.offset, rule.multiplier] + [0.0] * (len(equality.data) - 2)
        equality.solref = [max(0.004, 2 * step_s), 1.0]
        equality.solimp = [0.99, 0.999, 0.001, 0.5, 2.0]
        _free_from_limits(spec, robot.joint(name), robot.joint(rule.joint), rule, report)


def _free_from_limits(
    spec: mujoco.MjSpec, joint: Joint, leader: Joint, rule: Mimic, report: BuildReport
) -> None:
    """Drop limits that the leader drives a mimic joint past, because they fight the equality."""
    reached = _range(leader, rule)
    if joint.limit is None or reached is None:
        return
    lower, upper = joint.limit.lower, joint.limit.upper
    if lower - FITS_WITHIN <= reached[0] and reached[1] <= upper + FITS_WITHIN:
        return
    spec.joint(joint.name).limited = mujoco.mjtLimited.mjLIMITED_FALSE
    report.repair(
        f"joint '{joint.name}'",
        f"'{leader.name}' drives it from {reached[0]:.4g} to {reached[1]:.4g}, past its own "
        f"limits of {lower:.4g} and {upper:.4g}; those are not enforced",
        joint.line,
    )


def _range(leader: Joint, rule: Mimic) -> tuple[float, float] | None:
    limit: JointLimit | None = leader.limit
    if limit is None:
        return None
    ends = sorted(map(rule.position, (limit.lower, limit.upper)))
    return (ends[0], ends[1]) if all(map(math.isfinite, ends)) else None
