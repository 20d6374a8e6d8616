"""How hard each joint may brake, by the inertia matrix of the present pose.

A set-point plans each stop with the braking of its joint. The efforts that all stops need together
must be there whenever they begin, so the bounds share the efforts that gravity leaves.

Joints that accelerate by a in the present pose need the effort sum_j W_ij a_j of joint i at most,
where W holds the absolute values of the inertia matrix, mimic joints included. The budget of a
joint is half of the effort that gravity leaves it, of a joint at rest three quarters. Then

* alone, joint j may brake with the largest a_j that exceeds no joint's budget;
* a joint that moves keeps the braking that its present motion needs, even if the pose has changed
  so that this takes up to 0.9 of the effort; a joint that begins to move has a floor, half of what
  all joints can reach at once in the worst pose;
* what the budgets leave beyond these is shared: each joint gets the same fraction of the way to
  what it could do alone, as far as no budget of a joint that feels it is exceeded.

A sum beyond a budget arises only from floors, which take a quarter at most. So in one pose all
stops need no more than there is, whatever is commanded and when; of joints that move themselves at
most three quarters, as the pose changes on the way.

A bound is kept as a part of what the joint could do by itself. So it follows the joint's own
inertia and gravity in each period, and the matrix is looked at only when a joint begins to move,
and after each 0.3 rad. While commands come as samples of a motion nothing is renewed.
"""

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.servo_tuning import (
    EFFORT_SHARE,
    MIN_EFFORT_SHARE,
    ServoTuning,
    random_poses,
    set_armature,
)
from arm_gazebo.robot.actuation import UNLIMITED, RobotJoint

Array = NDArray[np.float64]

RENEW_EVERY = 0.3
"""Way of the fastest joint, in rad or m, after which the bounds are renewed."""
FLOOR = 0.5
"""Fraction of the braking that is possible in any pose that a joint can always plan with."""
RESTING = 2.0 / 3.0
"""Load of a joint at rest by the motion of others, as its budget counts it: it has to hold only,
so three quarters of the effort that gravity leaves it may go into that."""
LARGEST = 0.9 / EFFORT_SHARE
"""Largest braking that a motion keeps when the pose has changed under it, in budgets."""
LEAST_LEFT = MIN_EFFORT_SHARE / EFFORT_SHARE
"""Fraction of its effort that gravity leaves a joint at least."""
TINY = 1e-12


class BrakingLaw:
    """The bounds on the braking of one robot's joints.

    Each sum is in the order of the joints, so that one state and many give the same bits.

    Attributes:
        entries: indices in MuJoCo's sparse matrix of the inertia that joint j makes joint i feel,
            shape (layers, n, n); the layers add up.
        weights: the factors of these, 0 for none.
        related: whether joint j makes joint i feel its motion, shape (n, n).
        followers: inertia of mimic joints as their leaders feel it, shape (n,).
        jerkless: highest bounds, shape (n,).
    """

    def __init__(self, model: mujoco.MjModel, tuning: ServoTuning, dofs: NDArray[np.intp]) -> None:
        self.entries, self.weights = _terms(model, tuning, dofs)
        self.related = self.weights.any(axis=0)
        self.followers, self.jerkless = tuning.followers, tuning.jerkless
        self._jerkless: list[float] = tuning.jerkless.tolist()
        self._geared = bool(tuning.followers.any())
        self._pairs = np.zeros(self.related.shape)
        self._loads = np.zeros((2, *self.related.shape))

    def parts(
        self,
        inertia: Array,
        room: list[float],
        floors: list[float],
        needs: list[float],
    ) -> list[float]:
        """Return the bounds as parts of what each joint could do by itself; 0 for joints at rest.

        Args:
            inertia: MuJoCo's sparse inertia matrix, shape (nC,).
            room: inverses of the budgets, 0 for joints that no set-point holds.
            floors: lowest bounds.
            needs: braking that the present motions need; negative at rest.
        """
        felt, loads = self._pairs, self._loads
        # Lists where the joints are, arrays where their pairs are: that is the quickest.
        np.take(inertia, self.entries[0], out=felt, mode="clip")
        np.abs(felt, felt)
        np.multiply(felt, self.weights[0], felt)
        for entries, weights in zip(self.entries[1:], self.weights[1:], strict=True):
            felt += np.abs(inertia[entries]) * weights
        if self._geared:
            felt.ravel()[:: len(felt) + 1] += self.followers
        # Fractions of the budgets: [j, i] is that of joint i for an acceleration of joint j.
        np.multiply(felt, room, felt)
        sure, more = [0.0] * len(room), [0.0] * len(room)
        for each, most in enumerate(np.maximum.reduce(felt, axis=1).tolist()):
            need = needs[each]
            if need >= 0.0:
                if most < TINY:
                    most = TINY
                alone, kept = 1.0 / most, LARGEST / most
                if alone > self._jerkless[each]:
                    alone = self._jerkless[each]
                if need < kept:
                    kept = need
                if kept < floors[each]:
                    kept = floors[each]
                sure[each] = kept
                if alone > kept:
                    more[each] = alone - kept
        np.multiply(felt, np.array((sure, more))[:, :, None], loads)
        taken, asked = np.add.reduce(loads, axis=1).tolist()
        shares = [share(*each) for each in zip(taken, asked, strict=True)]
        if min(shares) < 1.0:
            least = np.minimum.reduce(np.where(self.related, shares, 1.0), axis=1)
            more = [each * fraction for each, fraction in zip(more, least.tolist(), strict=True)]
        own = felt.diagonal().tolist()
        return [load * (a + b) for load, a, b in zip(own, sure, more, strict=True)]

    def felt(self, inertia: Array) -> Array:
        """Return the inertia of joint j that joint i feels, shape (states, n, n)."""
        felt = np.abs(inertia[:, self.entries[0]]) * self.weights[0]
        for entries, weights in zip(self.entries[1:], self.weights[1:], strict=True):
            felt += np.abs(inertia[:, entries]) * weights
        if self._geared:
            own = np.arange(felt.shape[-1])
            felt[:, own, own] += self.followers
        return felt

    def parts_of_many(self, inertia: Array, room: Array, floors: Array, needs: Array) -> Array:
        """Return what `parts` returns for each of many states, with the same bits.

        Shapes: `inertia` (states, nC), `room` and `needs` (states, n), `floors` (n,).
        """
        felt = self.felt(inertia) * room[:, None, :]
        own = np.arange(felt.shape[-1])
        most = np.maximum(np.maximum.reduce(felt, axis=-1), TINY)
        alone = np.minimum(1.0 / most, self.jerkless)
        moves = needs >= 0.0
        sure = np.where(moves, np.maximum(np.minimum(needs, LARGEST / most), floors), 0.0)
        more = np.where(moves & (alone > sure), alone - sure, 0.0)
        taken = np.add.reduce(felt * sure[:, :, None], axis=-2)
        asked = np.add.reduce(felt * more[:, :, None], axis=-2)
        left = np.where(taken < 1.0, (1.0 - taken) / np.where(asked > 0.0, asked, 1.0), 0.0)
        shares = np.where(taken + asked <= 1.0, 1.0, left)
        least = np.minimum.reduce(np.where(self.related, shares[:, None, :], 1.0), axis=-1)
        return felt[:, own, own] * (sure + more * least)


def budget(effort: float, gravity: float) -> float:
    """Return the effort that a joint may need for all motions, its own and others."""
    if effort > UNLIMITED:
        effort = UNLIMITED
    left, least = effort - abs(gravity), LEAST_LEFT * effort
    return EFFORT_SHARE * (left if left > least else least)


def budgets(efforts: Array, gravity: Array) -> Array:
    """Return what `budget` returns for each joint of many states."""
    efforts = np.minimum(efforts, UNLIMITED)
    return EFFORT_SHARE * np.maximum(efforts - np.abs(gravity), LEAST_LEFT * efforts)


def share(taken: float, asked: float) -> float:
    """Return the fraction of what is asked for that is left of a budget of 1."""
    if taken + asked <= 1.0:
        return 1.0
    return (1.0 - taken) / asked if taken < 1.0 else 0.0


def _terms(
    model: mujoco.MjModel, tuning: ServoTuning, dofs: NDArray[np.intp]
) -> tuple[NDArray[np.intp], Array]:
    """Return the entries of the inertia matrix for each pair of joints, and their factors."""
    places = {
        (row, int(model.M_colind[entry])): entry
        for row in range(model.nv)
        for entry in range(model.M_rowadr[row], model.M_rowadr[row] + model.M_rownnz[row])
    }
    parts = [[(int(dof), 1.0)] for dof in dofs]
    for joint, follower, ratio in tuning.follower_ratios():
        parts[joint].append((follower, abs(ratio)))
    count = len(parts)
    found: dict[tuple[int, int], list[tuple[int, float]]] = {}
    for first in range(count):
        for second in range(count):
            pairs = [(a, b) for a in parts[first] for b in parts[second]]
            # Followers add to their leader's own inertia by `tuning.followers`.
            for (a, one), (b, other) in pairs if first != second else pairs[:1]:
                place = places.get((max(a, b), min(a, b)))
                if place is not None:
                    found.setdefault((first, second), []).append((place, one * other))
    layers = max(map(len, found.values()), default=1)
    entries = np.zeros((layers, count, count), dtype=np.intp)
    weights = np.zeros((layers, count, count))
    for cell, terms in found.items():
        for layer, (place, weight) in enumerate(terms):
            entries[(layer, *cell)], weights[(layer, *cell)] = place, weight
    return entries, weights


POSES = 21
SLOW = 2.0
"""Times the duration of a motion with the joint's own effort from which on it counts as slow."""
OWN_SHARE = 0.8
"""Fraction of its effort that this duration is for."""


def slow_joints(
    model: mujoco.MjModel, joints: Sequence[RobotJoint], tuning: ServoTuning, qpos: Array
) -> Iterator[tuple[str, str]]:
    """Yield the joints that are slow in most poses, with a sentence for each.

    The rotors of the model are not set; `qpos` (nq,) is a pose for everything that is not driven.
    """
    if not joints:
        return
    dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
    law = BrakingLaw(model, tuning, dofs)
    efforts = np.minimum(tuning.efforts, UNLIMITED)
    data = mujoco.MjData(model)
    times, loads = np.zeros((POSES, len(joints))), np.zeros((len(joints),) * 2)
    for dof, rotor in zip(dofs.tolist(), tuning.armature.tolist(), strict=True):
        set_armature(model, dof, rotor)
    for row, pose in enumerate(random_poses(joints, POSES)):
        data.qpos[:] = qpos
        data.qpos[[joint.qpos_address for joint in joints]] = pose
        mujoco.mj_forward(model, data)
        gravity = tuning.coupling.T @ (data.qfrc_bias - data.qfrc_gravcomp)
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
