"""Levenberg-Marquardt steps from one start towards a pose, inside the joints' limits.

Each step minimises the linearised error inside a box: the limits, and a trust region of one length
for each joint (Levenberg 1944, Marquardt 1963; the box as in Voglis and Lagaris 2004). A joint at
its limit so leaves the others free to move, where a step that is clipped afterwards gets stuck.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_planning.kinematics.chain import Chain

Array = NDArray[np.float64]

WITHIN_M, WITHIN_RAD = 1e-5, 1e-4
"""Errors below which a pose counts as reached."""
DONE_M, DONE_RAD = 1e-6, 1e-5
"""Errors below which a descent ends: a last step is cheap, but slow near a stretched arm."""
TRUST, MAX_TRUST, MIN_TRUST = 1.0, 1.5, 1e-3
"""Largest step of a joint: at the start, at most, and where the search gives up; rad or m."""
GOOD, EXPAND, SHRINK = 0.25, 2.0, 0.35
"""A step that leaves less than GOOD of the squared error makes the next ones longer."""
DAMPING = 0.1
"""Damping of J^T J as a share of the squared error: it vanishes at the target."""
MIN_DAMPING = 1e-8
MAX_STEPS = 60
HASTY, PATIENT = 0.8, 0.99
"""A descent ends at a step that leaves more than this share of the squared error: where another
start is at hand, and where the nearest pose is wanted. Giving up early costs some successes, but
saves more steps."""
NEAR = 0.1
"""Error, as a share of the target's rotation length, below which each descent is patient: a seed
beside the target leads to it even where the arm is nearly singular."""


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """A pose to reach.

    Attributes:
        position: in the root's frame, m, (3,).
        back: conjugate of its quaternion, w, x, y, z, (4,).
        rotation_length: length in m that one radian of error counts as; 0: any orientation will do.
        weights: factors of the three errors of the position and the three of the rotation, (6, 1).
    """

    position: Array
    back: Array
    rotation_length: float
    weights: Array


def target_of(
    position: Array, quaternion: Array, rotation_length: float, position_weight: float = 1.0
) -> Target:
    """Return a target for a position, (3,), and a quaternion w, x, y, z, (4,)."""
    back = quaternion.copy()
    back[1:] *= -1.0
    weights = np.full((6, 1), rotation_length)
    weights[:3] = position_weight
    return Target(position, back, rotation_length, weights)


@dataclass(frozen=True, slots=True, eq=False)
class DescentEnd:
    """Where a descent ends.

    Attributes:
        q: positions within the limits, (n,).
        off_m: distance from the target.
        off_rad: angle to the target's orientation.
        steps: evaluations of the pose.
    """

    q: Array
    off_m: float
    off_rad: float
    steps: int

    def is_at(self, target: Target, nearest: bool = False) -> bool:
        """Whether the target is reached; with `nearest`, only its position counts."""
        turned = nearest or not target.rotation_length or self.off_rad < WITHIN_RAD
        return self.off_m < WITHIN_M and turned


class Descent:
    """Descends from starts; keeps its arrays, so it is for one thread at a time.

    Args:
        chain: what is moved.
        lower: lower limits, (n,), or -inf.
        upper: upper limits, (n,), or inf.
    """

    def __init__(self, chain: Chain, lower: Array, upper: Array) -> None:
        n = len(lower)
        self._chain = chain
        # MuJoCo takes no bounds that are equal, which those of a joint that must not move are.
        least = 2.0 * np.spacing(np.maximum(np.abs(lower), 1.0))
        self._fixed = np.flatnonzero(upper - lower < least)
        self._values = lower[self._fixed]
        self._lower, self._upper = lower.copy(), upper.copy()
        self._lower[self._fixed] -= least[self._fixed]
        self._upper[self._fixed] += least[self._fixed]
        self._error, self._turn = np.zeros(6), np.zeros(4)
        self._offset, self._rotation = self._error[:3], self._error[3:]
        self._gradient, self._hessian = np.zeros(n), np.zeros((n, n))
        self._diagonal = self._hessian.reshape(-1)[:: n + 1]
        self._step, self._factor = np.zeros(n), np.zeros((n, n + 7))
        self._index = np.zeros(n, np.int32)
        self._down, self._up = np.zeros(n), np.zeros(n)

    def run(
        self, target: Target, start: Array, most: int = MAX_STEPS, patience: float = PATIENT
    ) -> DescentEnd:
        """Return the best positions on the way down from a start within the limits, (n,).

        It ends at the target, at a step that leaves more than the share `patience` of the squared
        error (`PATIENT` near the target), or after `most` evaluations.
        """
        # Squares, because each step takes 10 us and a root a third of one.
        done_m, done_rad = DONE_M**2, DONE_RAD**2 if target.rotation_length else math.inf
        position_weight, rotation_weight = target.weights[0, 0] ** 2, target.rotation_length**2
        q, trust, cost, steps = start, TRUST, math.inf, 0
        near = (NEAR * (target.rotation_length or self._chain.reach_m)) ** 2
        best, off_m, off_rad = start, math.inf, math.inf
        while steps < most:
            steps += 1
            metres, angle = self._evaluate(target, q)
            new = position_weight * metres + rotation_weight * angle
            if new < cost:
                is_slow = new > (patience if new > near else PATIENT) * cost
                if new < GOOD * cost and steps > 1:
                    trust = min(EXPAND * trust, MAX_TRUST)
                best, cost, off_m, off_rad = q, new, metres, angle
                if is_slow or (metres < done_m and angle < done_rad):
                    break
                self._linearise(target, cost)
            elif trust < MIN_TRUST:
                break
            else:
                trust *= SHRINK
            q = best + self._minimise(best, trust)
            if len(self._fixed):
                q[self._fixed] = self._values
        return DescentEnd(best, math.sqrt(off_m), math.sqrt(off_rad), steps)

    def _evaluate(self, target: Target, q: Array) -> tuple[float, float]:
        """Return the squares of the distance and of the angle of a state."""
        chain = self._chain
        chain.place(q)
        np.subtract(chain.position, target.position, out=self._offset)
        mujoco.mju_mulQuat(self._turn, chain.quaternion, target.back)
        mujoco.mju_quat2Vel(self._rotation, self._turn, 1.0)
        return self._offset.dot(self._offset), self._rotation.dot(self._rotation)

    def _linearise(self, target: Target, cost: float) -> None:
        """Set the Hessian and the gradient of the placed state."""
        jacobian = self._chain.jacobian()
        jacobian *= target.weights
        self._error *= target.weights[:, 0]
        np.dot(jacobian.T, jacobian, out=self._hessian)
        self._diagonal += min(DAMPING * cost, DAMPING) + MIN_DAMPING
        np.dot(self._error, jacobian, out=self._gradient)

    def _minimise(self, q: Array, trust: float) -> Array:
        """Return the step with the least linearised error inside limits and trust region."""
        # MuJoCo starts from what the result holds: without this, answers depend on the past.
        self._step.fill(0.0)
        mujoco.mju_boxQP(
            self._step,
            self._factor,
            self._index,
            self._hessian,
            self._gradient,
            np.maximum(np.subtract(self._lower, q, out=self._down), -trust, out=self._down),
            np.minimum(np.subtract(self._upper, q, out=self._up), trust, out=self._up),
        )
        return self._step
