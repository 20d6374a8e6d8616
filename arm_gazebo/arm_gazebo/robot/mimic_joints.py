"""Joints that follow others, as stiff equalities between their positions."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import mujoco

from arm_control.hardware_info import HardwareInfo
from arm_description.robot import Joint, JointLimit, Robot
from arm_gazebo.build_report import BuildReport

SCALAR_TYPES = ("revolute", "continuous", "prismatic")
FITS_WITHIN = 1e-3
"""How far, in rad or m, a follower may be driven past its own limit without a word."""


@dataclass(frozen=True, slots=True)
class Following:
    """A joint whose position is multiplier x position of `leader` + offset.

    The leader follows nobody: chains are resolved.
    """

    joint: str
    leader: str
    multiplier: float
    offset: float


def without_released(robot: Robot, hardware: Iterable[HardwareInfo]) -> Robot:
    """Return the robot whose joints follow no other where mimic="false" in the hardware says so."""
    free = {info.name for component in hardware for info in component.joints if info.mimic is None}
    joints = (replace(j, mimic=None) if j.name in free else j for j in robot.joints)
    return replace(robot, joints=tuple(joints))


def followings(robot: Robot, report: BuildReport) -> tuple[Following, ...]:
    """Return every joint that mimics another, with the end of its chain as its leader."""
    found = []
    for joint in robot.joints:
        if joint.mimic is None:
            continue
        leader, multiplier, offset = joint, 1.0, 0.0
        while leader.mimic is not None:
            offset += multiplier * leader.mimic.offset
            multiplier *= leader.mimic.multiplier
            leader = robot.joint(leader.mimic.joint)
        if joint.type not in SCALAR_TYPES or leader.type not in SCALAR_TYPES:
            report.warn(
                f"joint '{joint.name}'",
                f"it is {joint.type} and mimics '{leader.name}', which is {leader.type}; "
                "only joints with one degree of freedom can; it does not follow",
                joint.line,
            )
            continue
        found.append(Following(joint.name, leader.name, multiplier, offset))
    return tuple(found)


def add_equalities(
    spec: mujoco.MjSpec,
    robot: Robot,
    follow: tuple[Following, ...],
    step_s: float,
    report: BuildReport,
) -> None:
    """Tie followers to their leaders.

    MuJoCo's default tie lets a gripper's finger lag by 20 mrad; this one by 1.
    """
    for following in follow:
        equality = spec.add_equality(
            name=f"{following.joint}_mimic",
            type=mujoco.mjtEq.mjEQ_JOINT,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            name1=following.joint,
            name2=following.leader,
        )
        data = [following.offset, following.multiplier] + [0.0] * (len(equality.data) - 2)
        equality.data = data
        equality.solref = [max(0.004, 2 * step_s), 1.0]
        equality.solimp = [0.99, 0.999, 0.001, 0.5, 2.0]
        _free_from_limits(spec, following, robot, report)


def _free_from_limits(
    spec: mujoco.MjSpec, following: Following, robot: Robot, report: BuildReport
) -> None:
    """Drop limits that the leader drives a follower past: they would fight the tie."""
    joint, leader = robot.joint(following.joint), robot.joint(following.leader)
    reached = _range(leader, following)
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


def _range(leader: Joint, following: Following) -> tuple[float, float] | None:
    limit: JointLimit | None = leader.limit
    if limit is None:
        return None
    ends = sorted(
        following.multiplier * end + following.offset for end in (limit.lower, limit.upper)
    )
    return (ends[0], ends[1]) if all(map(math.isfinite, ends)) else None
