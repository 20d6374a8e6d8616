"""What the drives of many copies of one robot have in common and keep: limits, gains, indices."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.braking_law import BrakingLaw
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.drives.servo import CHECK_EVERY_S, SETTLE_S, Servo
from arm_gazebo.drives.servo_tuning import TIME_CONSTANT_S, resistance

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class DriveConstants:
    """Constants of the driven joints; arrays of shape (joints,).

    Attributes:
        modes: how the joints are driven.
        period_s: control period.
        rate_per_s: see `DrivenJoint`, proportional gain over the period.
        lead_s: time by which activations lead the set-points.
        effort: largest efforts, N m or N.
        speed: highest speeds of set-points, rad/s or m/s.
        velocity_limit: velocity limits of the joints.
        lower: lowest positions, rad or m.
        upper: highest positions.
        law: the bounds on braking, by the pose.
        braking: see `MotionBounds`, as the next two.
        jerkless: see there.
        slack: see there.
        friction: friction, N m or N.
        drag: damping.
        compliance: inverse of the stiffness.
        followers_inertia: inertia of mimic joints as the driven joints feel it.
        followers: see `ServoTuning.follower_ratios`.
        dofs: degrees of freedom.
        addresses: indices in qpos.
        diagonal: indices of the joints' own inertia in MuJoCo's sparse matrix.
        settle_ticks: control periods after which resting drives sleep.
        check_ticks: control periods between two looks whether something moved sleeping drives.
    """

    modes: tuple[DriveMode, ...]
    period_s: float
    rate_per_s: float
    lead_s: float
    effort: Array
    speed: Array
    velocity_limit: Array
    lower: Array
    upper: Array
    law: BrakingLaw
    braking: Array
    jerkless: Array
    slack: Array
    friction: Array
    drag: Array
    compliance: Array
    followers_inertia: Array
    followers: tuple[tuple[int, int, float], ...]
    dofs: Indices
    addresses: Indices
    diagonal: Indices
    settle_ticks: int
    check_ticks: int


def drive_constants(model: mujoco.MjModel, servo: Servo) -> DriveConstants:
    """Return the constants of a servo's joints, in their present modes.

    The model has the servo's joints, and the gains of their modes.
    """
    joints, tuning, timing = servo.joints, servo.tuning, servo.timing
    bounds = [tuning.bounds(index) for index in range(len(joints))]
    friction, drag = resistance(model, tuning.coupling)
    dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
    return DriveConstants(
        modes=tuple(servo.mode(index) for index in range(len(joints))),
        period_s=timing.period_s,
        rate_per_s=servo.proportional_gain / timing.period_s,
        lead_s=TIME_CONSTANT_S - timing.step_s,
        effort=np.array([joint.effort for joint in joints]),
        speed=np.array([joint.velocity for joint in joints]),
        velocity_limit=np.array([joint.velocity_limit for joint in joints]),
        lower=np.array([joint.lower for joint in joints]),
        upper=np.array([joint.upper for joint in joints]),
        law=servo.law,
        braking=np.array([bound.braking for bound in bounds]),
        jerkless=np.array([bound.jerkless for bound in bounds]),
        slack=np.array([bound.slack for bound in bounds]),
        friction=np.array(friction),
        drag=np.array(drag),
        compliance=1.0 / tuning.stiffness,
        followers_inertia=tuning.followers,
        followers=tuning.follower_ratios(),
        dofs=dofs,
        addresses=np.array([joint.qpos_address for joint in joints], dtype=np.intp),
        diagonal=model.M_rowadr[dofs] + model.M_rownnz[dofs] - 1,
        settle_ticks=math.ceil(SETTLE_S / timing.period_s),
        check_ticks=max(1, round(CHECK_EVERY_S / timing.period_s)),
    )
