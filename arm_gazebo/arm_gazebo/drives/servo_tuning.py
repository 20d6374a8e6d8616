"""What the servos of a robot may do, computed from its model: nothing is tuned by hand.

Random poses give, for each driven joint, the largest inertia that it feels and the largest
torque of gravity. From those follow:

* armature: the rotor that a geared motor adds, a tenth of the largest inertia or more: enough
  that the drive is stiff for its effort, which at 20 mrad of error is all in use. (Real geared
  joints reach 100 to 300 rad/s2 at full effort against their rotor alone, these 1000.) It also
  keeps the inertia matrix away from singular, M >= diag(armature). A drive that is limp, or
  commanded by effort, has the tenth only: it shall fall and swing as the links do.
* gears: joints that mimic a driven one get a fiftieth of its rotor, as seen through the gearing.
  MuJoCo ties joints as firmly as they are heavy, so bare fingers of some grams would give way
  long before the drive is at its effort limit.
* damping gain: 2 armature / step. A drive at its effort limit acts explicitly, whatever the
  integrator, and energy then falls in each step as long as step x diag(damping) <= 2 M. So no
  saturated drive can chatter, in any pose, however the joints couple.
* stiffness: damping / 20 ms, a loop that is damped well at every inertia.
* braking: accelerations that all joints can have at once in the worst pose, with half of the
  effort that gravity leaves.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.robot.joint import RobotJoint

Array = NDArray[np.float64]

ARMATURE_SHARE = 0.1
GEAR_SHARE = 0.02
TIME_CONSTANT_S = 0.02
FULL_EFFORT_ERROR = 0.02
"""Error in rad or m at which a drive uses all of its effort, at the latest."""
USUAL_EFFORT = 10.0
"""N m or N, taken for the size of a drive whose effort has no limit."""
USUAL_ACCELERATION = 50.0
"""rad/s2 or m/s2, at most, of a drive whose effort does not bound it: strong ones do no more."""
POSES = 200
POSE_SEED = 20240
EFFORT_SHARE = 0.5
LEAST_EFFORT_SHARE = 0.1
"""Of the effort limit, for a joint that can hardly hold the arm: it shall move all the same."""
SLOW_SHARE = 0.25
"""Of its velocity limit: a joint that damping keeps below it is worth a word."""
PERIODS_TO_FULL_SPEED = 2
"""Bound on acceleration where effort is plenty: what changes within a period is not planned."""
ENDLESS_RANGE = (-math.pi, math.pi)
LONGEST_SLIDE_M = 20.0
"""Ranges of sliding joints above this are taken for limits that nobody meant, as -1000 to 1000."""


@dataclass(frozen=True, slots=True)
class MotionBounds:
    """What the set-point of one joint may do; rad or m, and per second.

    Attributes:
        braking: deceleration that the joint can have anywhere, whatever the others do.
        jerkless: highest acceleration at all.
        slack: how far off the joint a set-point makes the drive use all of its effort.
    """

    braking: float
    jerkless: float
    slack: float


@dataclass(frozen=True, slots=True)
class ServoTuning:
    """Gains and bounds of the driven joints, arrays of shape (n,) in the joints' order.

    Attributes:
        stiffness: N m/rad or N/m.
        damping: N m s/rad or N s/m.
        armature: inertia of the rotors of drives that follow a set-point, kg m2 or kg.
        limp_armature: the same of drives that do not; those need no stiffness.
        efforts: limits, N m or N; inf for none.
        braking: accelerations that all joints can have at once anywhere, rad/s2 or m/s2.
        braking_efforts: what those ask for where they ask for most, without gravity, N m or N.
        jerkless: highest accelerations at all, rad/s2 or m/s2.
        gravity: largest efforts that gravity asks for, N m or N.
        followers: inertia that mimicking joints and their gears add to that of their leader, kg m2
            or kg.
        coupling: shape (nv, n): velocities of all degrees of freedom for those of the driven
            joints; mimicking joints move along.
    """

    stiffness: Array
    damping: Array
    armature: Array
    limp_armature: Array
    efforts: Array
    braking: Array
    braking_efforts: Array
    jerkless: Array
    gravity: Array
    followers: Array
    coupling: Array

    def bounds(self, index: int) -> MotionBounds:
        """Return what one joint's set-point may do."""
        return MotionBounds(
            braking=float(self.braking[index]),
            jerkless=float(self.jerkless[index]),
            slack=float(self.efforts[index] / self.stiffness[index]),
        )


def tune(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], qpos: Array, period_s: float
) -> ServoTuning:
    """Return the tuning of the driven joints, and give them the rotors of limp drives.

    Args:
        model: gets `dof_armature`, and what MuJoCo derives of it.
        joints: the driven joints.
        qpos: a pose for all that is not driven, shape (nq,).
        period_s: control period.
    """
    coupling = _coupling(model, joints)
    dofs = [joint.dof_address for joint in joints]
    model.dof_armature[dofs] = 0.0
    efforts = np.array([joint.effort for joint in joints])
    rotor = _rotor(efforts, model.opt.timestep)
    gears = _gear(model, coupling, dofs, rotor)
    inertia, own, gravity = _sample(model, joints, coupling, qpos)
    largest = inertia.diagonal() + gears
    limp_armature = ARMATURE_SHARE * largest
    armature = np.maximum(limp_armature, rotor)
    model.dof_armature[dofs] = limp_armature
    mujoco.mj_setConst(model, mujoco.MjData(model))
    damping = 2.0 * armature / model.opt.timestep
    speeds = np.array([joint.velocity for joint in joints])
    jerkless = speeds / (PERIODS_TO_FULL_SPEED * period_s)
    jerkless[np.isinf(efforts)] = np.minimum(jerkless[np.isinf(efforts)], USUAL_ACCELERATION)
    spare = np.maximum(EFFORT_SHARE * (efforts - gravity), LEAST_EFFORT_SHARE * efforts)
    worst = inertia + np.diag(armature + gears)
    braking = _shared_accelerations(worst, spare, jerkless)
    return ServoTuning(
        stiffness=damping / TIME_CONSTANT_S,
        damping=damping,
        armature=armature,
        limp_armature=limp_armature,
        efforts=efforts,
        braking=braking,
        braking_efforts=worst @ braking,
        jerkless=jerkless,
        gravity=gravity,
        followers=largest - own,
        coupling=coupling,
    )


def tuned_again(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    joints: Sequence[RobotJoint],
    tuning: ServoTuning,
) -> ServoTuning:
    """Return the tuning of the same joints in a model that has other things besides.

    What the joints feel of their own robot is as before, and so are gains and bounds.

    Args:
        model: gets the rotors of limp drives, as by `tune`; it has those of the followers.
        data: of the model; is written to.
        joints: the driven joints at their places in this model.
        tuning: of the joints in the model before.
    """
    coupling, dofs = _coupling(model, joints), [joint.dof_address for joint in joints]
    _gear(model, coupling, dofs, _rotor(tuning.efforts, model.opt.timestep))
    model.dof_armature[dofs] = tuning.limp_armature
    mujoco.mj_setConst(model, data)
    return replace(tuning, coupling=coupling)


def too_weak(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], tuning: ServoTuning
) -> Iterator[tuple[str, str]]:
    """Yield the driven joints whose effort limit is too small, and what is wrong with each."""
    friction, damping = resistance(model, tuning.coupling)
    loads = zip(joints, tuning.gravity.tolist(), friction, damping, strict=True)
    for joint, gravity, rubs, damps in loads:
        limit = f"its effort limit of {joint.effort:.4g}"
        fastest = (joint.effort - rubs) / damps if damps > 0 else math.inf
        if gravity > joint.effort:
            yield (
                joint.name,
                f"{limit} is below the {gravity:.4g} that gravity asks for in some poses; there "
                "it will sink",
            )
        elif rubs >= joint.effort:
            yield (
                joint.name,
                f"{limit} is not above its friction of {rubs:.4g}; it will hardly move",
            )
        elif fastest < SLOW_SHARE * joint.velocity:
            limited = math.isfinite(joint.velocity_limit)
            bound = "its velocity limit of" if limited else "the usual"
            yield (
                joint.name,
                f"{limit} moves it against its damping of {damps:.4g} at {fastest:.3g} at most, "
                f"far below {bound} {joint.velocity:.4g}",
            )


def resistance(model: mujoco.MjModel, coupling: Array) -> tuple[list[float], list[float]]:
    """Return friction and damping that driven joints feel, with those of all that moves along."""
    friction = np.abs(coupling).T.dot(model.dof_frictionloss)
    return friction.tolist(), (coupling**2).T.dot(model.dof_damping).tolist()


def _rotor(efforts: Array, step_s: float) -> Array:
    """Return the armature, shape (n,), whose stiffness needs FULL_EFFORT_ERROR for all effort."""
    bounded = np.where(np.isfinite(efforts), efforts, USUAL_EFFORT)
    return bounded / FULL_EFFORT_ERROR * TIME_CONSTANT_S * step_s / 2.0


def _gear(model: mujoco.MjModel, coupling: Array, dofs: Sequence[int], rotors: Array) -> Array:
    """Give each follower a share of the rotor of its leader.

    Args:
        model: gets the followers' `dof_armature`.
        coupling: see `ServoTuning`.
        dofs: of the leaders.
        rotors: of the leaders, shape (n,).

    Returns:
        What the leaders feel of it, shape (n,).
    """
    felt = np.zeros(len(dofs))
    for column, (dof, share) in enumerate(zip(dofs, GEAR_SHARE * rotors, strict=True)):
        ratios = coupling[:, column]
        followers = np.flatnonzero(ratios)
        followers = followers[followers != dof]
        model.dof_armature[followers] = share / ratios[followers] ** 2
        felt[column] = share * len(followers)
    return felt


def _coupling(model: mujoco.MjModel, joints: Sequence[RobotJoint]) -> Array:
    """Return how fast every degree of freedom moves with each driven joint, shape (nv, n)."""
    coupling = np.zeros((model.nv, len(joints)))
    columns = {joint.dof_address: column for column, joint in enumerate(joints)}
    for dof, column in columns.items():
        coupling[dof, column] = 1.0
    for equality in range(model.neq):
        if model.eq_type[equality] == mujoco.mjtEq.mjEQ_JOINT and model.eq_obj2id[equality] >= 0:
            follower = model.jnt_dofadr[model.eq_obj1id[equality]]
            leader = model.jnt_dofadr[model.eq_obj2id[equality]]
            if leader in columns:
                coupling[follower, columns[leader]] = model.eq_data[equality, 1]
    return coupling


def _sample(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], coupling: Array, qpos: Array
) -> tuple[Array, Array, Array]:
    """Return the most that the driven joints feel in random poses.

    Returns:
        Absolute inertia matrix with whatever moves along, shape (n, n); inertias of the joints
        alone, shape (n,); absolute efforts against gravity, shape (n,).
    """
    data = mujoco.MjData(model)
    random = np.random.default_rng(POSE_SEED)
    full, efforts = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    lower, upper = np.array([_range(joint) for joint in joints]).reshape(-1, 2).T
    addresses = [joint.qpos_address for joint in joints]
    dofs = [joint.dof_address for joint in joints]
    # A product with the few rows of the followers, not with thousands of zeros and ones.
    others = coupling.copy()
    others[dofs, range(len(dofs))] -= 1.0
    followers = np.flatnonzero(others.any(axis=1))
    ratios = others[followers]
    inertia, own, gravity = np.zeros((len(dofs),) * 2), np.zeros(len(dofs)), np.zeros(len(dofs))
    data.qpos[:] = qpos
    for _ in range(POSES):
        data.qpos[addresses] = random.uniform(lower, upper)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        mujoco.mj_fullM(model, data, full)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, efforts)
        columns = full[:, dofs] + full[:, followers] @ ratios
        felt = columns[dofs] + ratios.T @ columns[followers]
        np.maximum(inertia, np.abs(felt), out=inertia)
        np.maximum(own, full[dofs, dofs], out=own)
        np.maximum(gravity, np.abs(coupling.T @ efforts), out=gravity)
    return inertia, own, gravity


def _range(joint: RobotJoint) -> tuple[float, float]:
    width = joint.upper - joint.lower
    bounded = math.isfinite(width) and not (joint.linear and width > LONGEST_SLIDE_M)
    return (joint.lower, joint.upper) if bounded else ENDLESS_RANGE


def _shared_accelerations(inertia: Array, efforts: Array, bounds: Array) -> Array:
    """Return accelerations (n,) that together overload no joint, whatever their signs.

    Each joint starts with what it could do alone. Where the sum of all is too much for a joint,
    the largest contributions to its load are cut down to a common level.

    Args:
        inertia: largest absolute inertia matrix, shape (n, n).
        efforts: what each joint can spend, shape (n,); may be infinite.
        bounds: largest accelerations in any case, shape (n,).
    """
    accelerations = np.minimum(efforts / inertia.diagonal(), bounds)
    for row, effort in zip(inertia, efforts, strict=True):
        loads = row * accelerations
        if loads.sum() > effort:
            level = _level(loads, effort)
            cut = loads > level
            accelerations[cut] = level / row[cut]
    return accelerations


def _level(loads: Array, effort: float) -> float:
    """Return the level to which loads must be cut so that their sum is the effort."""
    ordered = np.sort(loads)[::-1]
    kept = effort - (ordered.sum() - ordered.cumsum())
    levels = kept / np.arange(1, len(loads) + 1)
    # The right number of cut loads is the first whose level lies above the largest kept one.
    following = np.append(ordered[1:], 0.0)
    return float(levels[np.argmax(levels >= following)])
