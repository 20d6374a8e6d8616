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
SHRINK = 0.35
DAMPING = 0.1
"""Damping of J^T J as a share of the squared error: it vanishes at the target."""
MIN_DAMPING = 1e-8
SLOW, PATIENCE = 0.98, 4
"""Gives up after this many steps in a row that leave so much of the squared error."""
MAX_STEPS = 60


@dataclass(frozen=True, slots=True)
class Target:
    """A pose to reach.

    Attributes:
        position: in the root's frame, m, (3,).
        quaternion: w, x, y, z, (4,).
        position_weight: factor of the position's error.
        rotation_length: length in m that one radian of error counts as; 0: any orientation will do.
    """

    position: Array
    quaternion: Array
    position_weight: float
    rotation_length: float


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
        self._lower, self._upper = lower, upper
        self._error, self._turn, self._back = np.zeros(6), np.zeros(4), np.zeros(4)
        self._offset, self._rotation = self._error[:3], self._error[3:]
        self._hessian = np.zeros((n, n))
        self._diagonal = self._hessian.reshape(-1)[:: n + 1]
        self._step, self._factor = np.zeros(n), np.zeros((n, n + 7))
        self._index = np.zeros(n, np.int32)

    def run(self, target: Target, start: Array, most: int = MAX_STEPS) -> DescentEnd:
        """Return the best positions on the way down from a start within the limits, (n,).

        It ends at the target, at a local minimum, or after `most` evaluations.
        """
        q, trust, cost, slow, steps = start, TRUST, math.inf, 0, 0
        best, gradient = DescentEnd(start, math.inf, math.inf, 0), np.zeros_like(start)
        while steps < most:
            steps += 1
            off_m, off_rad, new = self._evaluate(target, q)
            if new < cost:
                if off_m < DONE_M and (off_rad < DONE_RAD or not target.rotation_length):
                    return DescentEnd(q, off_m, off_rad, steps)
                slow = slow + 1 if new > SLOW * cost else 0
                if new < 0.25 * cost and steps > 1:
                    trust = min(2.0 * trust, MAX_TRUST)
                best, cost = DescentEnd(q, off_m, off_rad, steps), new
                gradient = self._linearise(target, cost)
            else:
                trust *= SHRINK
            if slow >= PATIENCE or trust < MIN_TRUST:
                break
            q = best.q + self._minimise(gradient, best.q, trust)
        return DescentEnd(best.q, best.off_m, best.off_rad, steps)

    def _evaluate(self, target: Target, q: Array) -> tuple[float, float, float]:
        """Return the distance, the angle and the weighted squared error of a state."""
        chain = self._chain
        chain.place(q)
        np.subtract(target.position, chain.position, out=self._offset)
        mujoco.mju_negQuat(self._back, chain.quaternion)
        mujoco.mju_mulQuat(self._turn, target.quaternion, self._back)
        mujoco.mju_quat2Vel(self._rotation, self._turn, 1.0)
        metres, angle = self._offset.dot(self._offset), self._rotation.dot(self._rotation)
        cost = target.position_weight**2 * metres + target.rotation_length**2 * angle
        return math.sqrt(metres), math.sqrt(angle), cost

    def _linearise(self, target: Target, cost: float) -> Array:
        """Set the Hessian of the placed state, and return the gradient."""
        jacobian = self._chain.jacobian()
        if target.position_weight != 1.0:
            jacobian[:3] *= target.position_weight
            self._offset *= target.position_weight
        jacobian[3:] *= target.rotation_length
        self._rotation *= target.rotation_length
        np.dot(jacobian.T, jacobian, out=self._hessian)
        self._diagonal += min(DAMPING * cost, DAMPING) + MIN_DAMPING
        return -(self._error @ jacobian)

    def _minimise(self, gradient: Array, q: Array, trust: float) -> Array:
        """Return the step with the least linearised error inside limits and trust region."""
        # MuJoCo starts from what the result holds: without this, answers depend on the past.
        self._step.fill(0.0)
        mujoco.mju_boxQP(
            self._step,
            self._factor,
            self._index,
            self._hessian,
            gradient,
            np.maximum(self._lower - q, -trust),
            np.minimum(self._upper - q, trust),
        )
        return self._step
