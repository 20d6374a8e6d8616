"""Copy the state of one model to another, matched by name."""

from collections.abc import Collection, Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

POSITIONS = {
    mujoco.mjtJoint.mjJNT_FREE: 7,
    mujoco.mjtJoint.mjJNT_BALL: 4,
    mujoco.mjtJoint.mjJNT_SLIDE: 1,
    mujoco.mjtJoint.mjJNT_HINGE: 1,
}
VELOCITIES = {
    mujoco.mjtJoint.mjJNT_FREE: 6,
    mujoco.mjtJoint.mjJNT_BALL: 3,
    mujoco.mjtJoint.mjJNT_SLIDE: 1,
    mujoco.mjtJoint.mjJNT_HINGE: 1,
}
DRIVE_ARRAYS = (
    "actuator_gainprm",
    "actuator_biasprm",
    "actuator_forcerange",
    "actuator_forcelimited",
)
Indices = NDArray[np.intp]
Pair = tuple[int, int]


class StateTransfer:
    """Copies positions, velocities, drives and warm starts between states of two models.

    The constructor looks up each name once; `carry` only copies.

    Args:
        source: the model whose state is known.
        target: the model that continues from that state.
        roots: top-level bodies whose joints are copied; the joints of other bodies keep the
            target's state.
    """

    def __init__(
        self, source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
    ) -> None:
        joints = list(_joints(source, target, roots))
        kinds = [mujoco.mjtJoint(int(source.jnt_type[one])) for one, _ in joints]
        self._positions = _blocks(
            [(source.jnt_qposadr[a], target.jnt_qposadr[b]) for a, b in joints],
            [POSITIONS[kind] for kind in kinds],
        )
        self._velocities = _blocks(
            [(source.jnt_dofadr[a], target.jnt_dofadr[b]) for a, b in joints],
            [VELOCITIES[kind] for kind in kinds],
        )
        actuators = list(_actuators(source, target, dict(joints)))
        self._controls = _blocks(actuators, [1] * len(actuators))
        driven = [(a, b) for a, b in actuators if source.actuator_actnum[a]]
        self._activations = _blocks(
            [(source.actuator_actadr[a], target.actuator_actadr[b]) for a, b in driven],
            [int(source.actuator_actnum[a]) for a, _ in driven],
        )
        mocaps = list(_mocaps(source, target, roots))
        self._mocaps = _blocks(mocaps, [1] * len(mocaps))

    def carry(self, source: mujoco.MjData, target: mujoco.MjData) -> None:
        """Copy the state of the first model to the state of the second one."""
        target.time = source.time
        for (there, here), before, after in (
            (self._positions, source.qpos, target.qpos),
            (self._velocities, source.qvel, target.qvel),
            (self._velocities, source.qacc_warmstart, target.qacc_warmstart),
            (self._controls, source.ctrl, target.ctrl),
            (self._activations, source.act, target.act),
            (self._mocaps, source.mocap_pos, target.mocap_pos),
            (self._mocaps, source.mocap_quat, target.mocap_quat),
        ):
            after[here] = before[there]

    def carry_positions(self, source: NDArray[np.float64], target: NDArray[np.float64]) -> None:
        """Copy generalised positions (nq,) of the first model to those of the second one."""
        there, here = self._positions
        target[here] = source[there]

    def carry_drives(self, source: mujoco.MjModel, target: mujoco.MjModel) -> None:
        """Copy the drives' rotors, gains and limits, which are set on the running model."""
        there, here = self._velocities
        rotors = source.dof_armature[there]
        # As `Servo` does when it sets them.
        target.dof_M0[here] += rotors - target.dof_armature[here]
        target.dof_armature[here] = rotors
        there, here = self._controls
        for name in DRIVE_ARRAYS:
            getattr(target, name)[here] = getattr(source, name)[there]


def _joints(
    source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
) -> Iterator[Pair]:
    known = {target.joint(joint).name: joint for joint in range(target.njnt)}
    for joint in range(source.njnt):
        other = known.get(source.joint(joint).name)
        root = source.body(source.body_rootid[source.jnt_bodyid[joint]]).name
        if other is not None and root in roots and target.jnt_type[other] == source.jnt_type[joint]:
            yield joint, other


def _actuators(
    source: mujoco.MjModel, target: mujoco.MjModel, joints: dict[int, int]
) -> Iterator[Pair]:
    known = {target.actuator(actuator).name: actuator for actuator in range(target.nu)}
    at_joint = mujoco.mjtTrn.mjTRN_JOINT
    for actuator in range(source.nu):
        other = known.get(source.actuator(actuator).name)
        if other is None or target.actuator_actnum[other] != source.actuator_actnum[actuator]:
            continue
        if source.actuator_trntype[actuator] == at_joint:
            joint = int(source.actuator_trnid[actuator, 0])
            if joints.get(joint) != int(target.actuator_trnid[other, 0]):
                continue
        yield actuator, other


def _mocaps(
    source: mujoco.MjModel, target: mujoco.MjModel, roots: Collection[str]
) -> Iterator[Pair]:
    known = {target.body(body).name: body for body in range(target.nbody)}
    for body in np.flatnonzero(source.body_mocapid >= 0).tolist():
        name = source.body(body).name
        other = known.get(name)
        if other is None or name not in roots or target.body_mocapid[other] < 0:
            continue
        # A body with another pose in the target model was moved there on purpose.
        if np.array_equal(source.body_pos[body], target.body_pos[other]) and np.array_equal(
            source.body_quat[body], target.body_quat[other]
        ):
            yield int(source.body_mocapid[body]), int(target.body_mocapid[other])


def _blocks(starts: list[Pair], sizes: list[int]) -> tuple[Indices, Indices]:
    """Return the indices of blocks of values in both models, shape (n,) each."""
    there = [int(a) + k for (a, _), size in zip(starts, sizes, strict=True) for k in range(size)]
    here = [int(b) + k for (_, b), size in zip(starts, sizes, strict=True) for k in range(size)]
    return np.array(there, dtype=np.intp), np.array(here, dtype=np.intp)
