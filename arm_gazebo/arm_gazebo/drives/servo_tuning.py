"""Compute the gains and motion bounds of a robot's servos from its model, without hand tuning.

Random poses give, for each driven joint, the largest inertia and the largest gravity torque. The
tuning follows from these:

* armature: the reflected rotor inertia of a geared motor, a tenth of the largest inertia or more.
  It is large enough that the drive is stiff for its effort: an error of 20 mrad uses all of it.
  (Against their rotor alone, real geared joints reach 100 to 300 rad/s2 at full effort, and these
  reach 1000.) It also keeps the inertia matrix from being singular: M >= diag(armature). A drive
  that is free or commanded by effort has no rotor, so the joint falls and swings as its links do.
* gears: joints that mimic a driven joint get a fiftieth of its rotor, seen through the gearing.
  MuJoCo's equality constraints are as firm as the joints are heavy, so bare fingers of some grams
  would yield long before the drive reaches its effort limit. Gears apply unless the drive is free.
* damping gain: 2 armature / step. A drive at its effort limit acts explicitly with any integrator,
  and then the energy decreases in each step as long as step x diag(damping) <= 2 M. A saturated
  drive therefore cannot chatter, in any pose and with any coupling between joints.
* stiffness: damping / 20 ms, which makes a well-damped loop at every inertia.
* braking: accelerations that all joints can reach at once in the worst pose, with half of the
  effort that gravity leaves. `braking_law` has what they can do in the present pose.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.robot.actuation import RobotJoint
from arm_node.frozen import frozen

Array = NDArray[np.float64]
Gears = tuple[tuple[int, float], ...]
"""Pairs of the index of a degree of freedom and its armature."""

ARMATURE_SHARE = 0.1
GEAR_SHARE = 0.02
TIME_CONSTANT_S = 0.02
FULL_EFFORT_ERROR = 0.02
"""Largest error in rad or m at which a drive does not yet use all of its effort."""
DEFAULT_EFFORT = 10.0
"""Effort in N m or N that sizes a drive without an effort limit."""
FRICTION_SHARE = 0.25
"""Fraction of its sizing effort that a drive without an effort limit uses against friction."""
DEFAULT_ACCELERATION = 50.0
"""Largest acceleration in rad/s2 or m/s2 of a drive without an effort limit; strong real drives
do no more."""
POSES = 200
POSE_SEED = 20240
EFFORT_SHARE = 0.5
MIN_EFFORT_SHARE = 0.1
"""Fraction of the effort limit that is always planned with, so that a joint that can hardly hold
the arm still moves."""
SLOW_SHARE = 0.25
"""Fraction of the velocity limit: a joint that damping keeps below it causes a warning."""
PERIODS_TO_FULL_SPEED = 2
"""Bounds the acceleration where effort is plentiful: no plan resolves less than a period."""
CONTINUOUS_RANGE = (-math.pi, math.pi)
MAX_SLIDE_M = 20.0
"""A wider range of a sliding joint, such as -1000 to 1000, does not count as a real limit."""


@frozen
class MotionBounds:
    """Bounds on the set-point of one joint; rad or m, and per second.

    Attributes:
        braking: deceleration that the joint can reach in any pose, whatever the others do.
        jerkless: highest acceleration in any case.
        slack: distance of the set-point from the joint at which the drive uses all of its effort.
    """

    braking: float
    jerkless: float
    slack: float


@frozen
class ServoTuning:
    """Gains and bounds of the driven joints, arrays of shape (n,) in the joints' order.

    Attributes:
        stiffness: N m/rad or N/m.
        damping: N m s/rad or N s/m.
        armature: inertia of the rotors of drives that follow a set-point, kg m2 or kg.
        shares: a tenth of the largest inertias, for MuJoCo's constants, kg m2 or kg.
        gears: for each joint, the degrees of freedom that mimic it and their armatures.
        efforts: effort limits, N m or N; inf for none.
        sizing: efforts that size the drives: the limits, or what a drive without a limit needs.
        braking: accelerations that all joints can reach at once in any pose, rad/s2 or m/s2.
        braking_efforts: efforts that these need in the worst pose, without gravity, N m or N.
        jerkless: highest accelerations in any case, rad/s2 or m/s2.
        gravity: largest efforts against gravity, N m or N.
        followers: inertia that mimic joints and their gears add to their leader, kg m2 or kg.
        coupling: shape (nv, n): velocities of all degrees of freedom per velocity of each driven
            joint; mimic joints move with their leader.
    """

    stiffness: Array
    damping: Array
    armature: Array
    shares: Array
    gears: tuple[Gears, ...]
    efforts: Array
    sizing: Array
    braking: Array
    braking_efforts: Array
    jerkless: Array
    gravity: Array
    followers: Array
    coupling: Array

    def bounds(self, index: int) -> MotionBounds:
        """Return the bounds on one joint's set-point."""
        return MotionBounds(
            braking=float(self.braking[index]),
            jerkless=float(self.jerkless[index]),
            slack=float(self.efforts[index] / self.stiffness[index]),
        )

    def follower_ratios(self) -> tuple[tuple[int, int, float], ...]:
        """Return each mimic joint: index of its driven joint, its own dof, its ratio."""
        return tuple(
            (column, follower, float(self.coupling[follower, column]))
            for column, pairs in enumerate(self.gears)
            for follower, _ in pairs
        )


def tune(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], qpos: Array, period_s: float
) -> ServoTuning:
    """Return the tuning of the driven joints, which move freely afterwards.

    Args:
        model: receives the constants that MuJoCo derives from inertias, with a tenth of each
            joint's inertia as its rotor. The stiffness of contacts and stops therefore does not
            change with the mode of a drive.
        joints: the driven joints.
        qpos: a pose for everything that is not driven, shape (nq,).
        period_s: control period.
    """
    coupling = _coupling(model, joints)
    dofs = [joint.dof_address for joint in joints]
    model.dof_armature[dofs] = 0.0
    efforts = np.array([joint.effort for joint in joints])
    speeds = np.array([joint.velocity for joint in joints])
    sizing = _sizing(model, coupling, efforts, speeds)
    rotor = _rotor(sizing, model.opt.timestep)
    gears, felt = _gear(model, coupling, dofs, rotor)
    inertia, own, gravity = _sample(model, joints, coupling, qpos)
    largest = inertia.diagonal() + felt
    shares = ARMATURE_SHARE * largest
    armature = np.maximum(shares, rotor)
    _derive(model, mujoco.MjData(model), dofs, shares, gears)
    damping = 2.0 * armature / model.opt.timestep
    jerkless = speeds / (PERIODS_TO_FULL_SPEED * period_s)
    jerkless[np.isinf(efforts)] = np.minimum(jerkless[np.isinf(efforts)], DEFAULT_ACCELERATION)
    worst = inertia + np.diag(armature + felt)
    braking = _braking(worst, efforts, gravity, jerkless)
    return ServoTuning(
        stiffness=damping / TIME_CONSTANT_S,
        damping=damping,
        armature=armature,
        shares=shares,
        gears=gears,
        efforts=efforts,
        sizing=sizing,
        braking=braking,
        braking_efforts=worst @ braking,
        jerkless=jerkless,
        gravity=gravity,
        followers=largest - own,
        coupling=coupling,
    )


def retune(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    joints: Sequence[RobotJoint],
    tuning: ServoTuning,
) -> ServoTuning:
    """Return the tuning of the same joints in a model in which other entities have changed.

    The robot's own inertias are unchanged, and so are gains and bounds.

    Args:
        model: receives the constants that MuJoCo derives from inertias, as in `tune`. Its
            armatures may already be set.
        data: state of the model; it is overwritten.
        joints: the driven joints in this model.
        tuning: tuning of the joints in the previous model.
    """
    coupling, dofs = _coupling(model, joints), [joint.dof_address for joint in joints]
    gears, _ = _gear(model, coupling, dofs, _rotor(tuning.sizing, model.opt.timestep))
    _derive(model, data, dofs, tuning.shares, gears)
    return replace(tuning, coupling=coupling, gears=gears)


def tuned_for_gravity(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], qpos: Array, tuning: ServoTuning
) -> ServoTuning:
    """Return the tuning of the same joints under the gravity of this model.

    Gains stay. The accelerations that every pose allows are those that `tune` would find.

    Args:
        model: a model that no simulation uses; its armatures are overwritten.
        joints: the driven joints.
        qpos: see `tune`.
        tuning: tuning of the joints under another gravity.
    """
    dofs = [joint.dof_address for joint in joints]
    model.dof_armature[dofs] = 0.0
    _, felt = _gear(model, tuning.coupling, dofs, _rotor(tuning.sizing, model.opt.timestep))
    inertia, _, gravity = _sample(model, joints, tuning.coupling, qpos)
    worst = inertia + np.diag(tuning.armature + felt)
    braking = _braking(worst, tuning.efforts, gravity, tuning.jerkless)
    return replace(tuning, braking=braking, braking_efforts=worst @ braking, gravity=gravity)


def rederive(model: mujoco.MjModel, joints: Sequence[RobotJoint], tuning: ServoTuning) -> None:
    """Let MuJoCo derive its constants again after masses have changed; armatures stay."""
    dofs = [joint.dof_address for joint in joints]
    driven = [*dofs, *(follower for pairs in tuning.gears for follower, _ in pairs)]
    present = model.dof_armature[driven]
    gears, _ = _gear(model, tuning.coupling, dofs, _rotor(tuning.sizing, model.opt.timestep))
    _derive(model, mujoco.MjData(model), dofs, tuning.shares, gears)
    for dof, armature in zip(driven, present.tolist(), strict=True):
        set_armature(model, dof, armature)


def weak_drives(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], tuning: ServoTuning
) -> Iterator[tuple[str, str]]:
    """Yield the driven joints whose effort limit is too small, with a sentence for each."""
    frictions, dampings = resistance(model, tuning.coupling)
    loads = zip(joints, tuning.gravity.tolist(), frictions, dampings, strict=True)
    for joint, gravity, friction, damping in loads:
        limit = f"its effort limit of {joint.effort:.4g}"
        fastest = (joint.effort - friction) / damping if damping > 0 else math.inf
        if gravity > joint.effort:
            yield (
                joint.name,
                f"{limit} is below the {gravity:.4g} that gravity needs in some poses; it will "
                "sink there",
            )
        elif friction >= joint.effort:
            yield (
                joint.name,
                f"{limit} is not above its friction of {friction:.4g}; it will hardly move",
            )
        elif fastest < SLOW_SHARE * joint.velocity:
            limited = math.isfinite(joint.velocity_limit)
            bound = "its velocity limit of" if limited else "the default of"
            yield (
                joint.name,
                f"{limit} moves it against its damping of {damping:.4g} at {fastest:.3g} at most, "
                f"far below {bound} {joint.velocity:.4g}",
            )


def _braking(worst: Array, efforts: Array, gravity: Array, jerkless: Array) -> Array:
    """Return the accelerations (n,) that all joints can reach at once in any pose.

    Args:
        worst: largest absolute inertia matrix, shape (n, n).
        efforts: effort limits, shape (n,).
        gravity: largest efforts against gravity, shape (n,).
        jerkless: highest accelerations in any case, shape (n,).
    """
    spare = np.maximum(EFFORT_SHARE * (efforts - gravity), MIN_EFFORT_SHARE * efforts)
    return _shared_accelerations(worst, spare, jerkless)


def resistance(model: mujoco.MjModel, coupling: Array) -> tuple[list[float], list[float]]:
    """Return friction and damping of the driven joints, including their mimic joints."""
    friction = np.abs(coupling).T.dot(model.dof_frictionloss)
    return friction.tolist(), (coupling**2).T.dot(model.dof_damping).tolist()


def _sizing(model: mujoco.MjModel, coupling: Array, efforts: Array, speeds: Array) -> Array:
    """Return the efforts (n,) that size the drives.

    A drive without a limit works against friction and damping beside its default effort. Friction
    ends with the motion, and the error swings by friction over stiffness then.
    """
    friction, damping = map(np.array, resistance(model, coupling))
    needed = DEFAULT_EFFORT + friction / FRICTION_SHARE + damping * speeds
    return np.where(np.isfinite(efforts), efforts, needed)


def _rotor(sizing: Array, step_s: float) -> Array:
    """Return the armature (n,) with whose stiffness FULL_EFFORT_ERROR uses the whole effort."""
    return sizing / FULL_EFFORT_ERROR * TIME_CONSTANT_S * step_s / 2.0


def set_armature(model: mujoco.MjModel, dof: int, armature: float) -> None:
    """Change the inertia of a rotor while the model runs."""
    # MuJoCo takes the inertia of a freely moving body from `dof_M0`, which it never recomputes.
    model.dof_M0[dof] += armature - model.dof_armature[dof]
    model.dof_armature[dof] = armature


def _derive(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    dofs: Sequence[int],
    rotors: Array,
    gears: Sequence[Gears],
) -> None:
    """Let MuJoCo derive its constants with the given rotors and gears, then remove both."""
    model.dof_armature[dofs] = rotors
    mujoco.mj_setConst(model, data)
    for dof in (*dofs, *(follower for pairs in gears for follower, _ in pairs)):
        set_armature(model, dof, 0.0)


def _gear(
    model: mujoco.MjModel, coupling: Array, dofs: Sequence[int], rotors: Array
) -> tuple[tuple[Gears, ...], Array]:
    """Give each mimic joint a fraction of its leader's rotor.

    Args:
        model: receives the mimic joints' `dof_armature`.
        coupling: see `ServoTuning`.
        dofs: degrees of freedom of the leaders.
        rotors: rotors of the leaders, shape (n,).

    Returns:
        The mimic joints of each leader with their armatures; the inertia that these add to each
        leader, shape (n,).
    """
    felt, gears = np.zeros(len(dofs)), list[Gears]()
    for column, (dof, share) in enumerate(zip(dofs, GEAR_SHARE * rotors, strict=True)):
        ratios = coupling[:, column]
        followers = np.flatnonzero(ratios)
        followers = followers[followers != dof]
        model.dof_armature[followers] = share / ratios[followers] ** 2
        gears.append(tuple((int(f), float(model.dof_armature[f])) for f in followers))
        felt[column] = share * len(followers)
    return tuple(gears), felt


def _coupling(model: mujoco.MjModel, joints: Sequence[RobotJoint]) -> Array:
    """Return the velocity of every degree of freedom per driven joint, shape (nv, n)."""
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
    """Return the largest inertias and gravity efforts of the driven joints in random poses.

    Returns:
        Absolute inertia matrix including mimic joints, shape (n, n); inertias of the joints
        alone, shape (n,); absolute efforts against gravity, shape (n,).
    """
    data = mujoco.MjData(model)
    full, efforts = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    addresses = [joint.qpos_address for joint in joints]
    dofs = [joint.dof_address for joint in joints]
    # Multiply only the few rows of mimic joints, not thousands of zeros and ones.
    others = coupling.copy()
    others[dofs, range(len(dofs))] -= 1.0
    followers = np.flatnonzero(others.any(axis=1))
    ratios = others[followers]
    driven = np.ix_(dofs, dofs)
    inertia, own, gravity = np.zeros((len(dofs),) * 2), np.zeros(len(dofs)), np.zeros(len(dofs))
    data.qpos[:] = qpos
    for pose in random_poses(joints, POSES):
        data.qpos[addresses] = pose
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        mujoco.mj_fullM(model, data, full)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, efforts)
        if model.ngravcomp:
            mujoco.mj_passive(model, data)
            efforts -= data.qfrc_gravcomp
        felt = full[driven]
        np.maximum(own, felt.diagonal(), out=own)
        if len(followers):
            columns = full[:, dofs] + full[:, followers] @ ratios
            felt = columns[dofs] + ratios.T @ columns[followers]
        np.maximum(inertia, np.abs(felt), out=inertia)
        np.maximum(gravity, np.abs(coupling.T @ efforts), out=gravity)
    return inertia, own, gravity


def random_poses(joints: Sequence[RobotJoint], count: int) -> Iterator[Array]:
    """Yield positions (n,) of joints within their limits, the same ones each time."""
    random = np.random.default_rng(POSE_SEED)
    lower, upper = np.array([_range(joint) for joint in joints]).reshape(-1, 2).T
    for _ in range(count):
        yield random.uniform(lower, upper)


def _range(joint: RobotJoint) -> tuple[float, float]:
    width = joint.upper - joint.lower
    bounded = math.isfinite(width) and not (joint.linear and width > MAX_SLIDE_M)
    return (joint.lower, joint.upper) if bounded else CONTINUOUS_RANGE


def _shared_accelerations(inertia: Array, efforts: Array, bounds: Array) -> Array:
    """Return accelerations (n,) that overload no joint when combined, with any signs.

    Each joint starts with the acceleration that it could reach alone. If the sum overloads a joint,
    the largest contributions to its load are cut to a common level.

    Args:
        inertia: largest absolute inertia matrix, shape (n, n).
        efforts: available effort of each joint, shape (n,); may be infinite.
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
    # The number of loads to cut is the first whose level is above the largest load that remains.
    following = np.append(ordered[1:], 0.0)
    return float(levels[np.argmax(levels >= following)])
