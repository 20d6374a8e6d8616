"""Find the joints that move slowly because another joint cannot hold against their motion."""

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.braking_law import RESTING, BrakingLaw, budgets
from arm_gazebo.drives.servo_tuning import ServoTuning, random_poses, set_armature
from arm_gazebo.robot.actuation import RobotJoint

Array = NDArray[np.float64]

POSES = 21
SLOW = 2.0
"""Times the duration of a motion with the joint's own effort from which on it counts as slow."""
OWN_SHARE = 0.8
"""Fraction of its effort that this duration is for."""


def slow_joints(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], tuning: ServoTuning, qpos: Array
) -> Iterator[tuple[str, str]]:
    """Yield the joints that are slow in most poses, with a sentence for each.

    Args:
        model: the model, tuned; its rotors are not set.
        joints: the driven joints.
        tuning: their tuning.
        qpos: a pose for everything that is not driven, shape (nq,).
    """
    if not joints:
        return
    dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
    law = BrakingLaw(model, tuning, dofs)
    efforts = np.minimum(tuning.efforts, 1e9)
    data = mujoco.MjData(model)
    times, loads = np.zeros((POSES, len(joints))), np.zeros((len(joints),) * 2)
    for dof, rotor in zip(dofs.tolist(), tuning.armature.tolist(), strict=True):
        set_armature(model, dof, rotor)
    for row, pose in enumerate(random_poses(joints, POSES)):
        data.qpos[:] = qpos
        data.qpos[[joint.qpos_address for joint in joints]] = pose
        mujoco.mj_forward(model, data)
        gravity = tuning.coupling.T @ data.qfrc_bias
        felt = law.felt(data.M[None])[0]
        # [j, i]: each joint alone, while the others hold.
        others = np.where(np.eye(len(joints), dtype=bool), 1.0, RESTING)
        loads += (load := others * felt / budgets(efforts, gravity))
        own = np.maximum(OWN_SHARE * efforts - np.abs(gravity), 0.0) / felt.diagonal()
        own = np.minimum(own, law.jerkless)
        alone = np.minimum(1.0 / load.max(axis=1), law.jerkless)
        times[row] = np.sqrt(own / alone)
    for dof in dofs.tolist():
        set_armature(model, dof, 0.0)
    for each, longer in enumerate(np.median(times, axis=0).tolist()):
        weakest = joints[int(loads[each].argmax())]
        if longer > SLOW and weakest is not joints[each]:
            yield (
                joints[each].name,
                f"it takes {longer:.2g} times as long as its own effort would allow, because "
                f"'{weakest.name}' with its effort limit of {weakest.effort:.4g} could not hold "
                "against a faster motion",
            )
