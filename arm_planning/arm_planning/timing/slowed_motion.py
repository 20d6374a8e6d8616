"""A motion that is slowed down where its joints could not follow.

The motion itself is the path, and its time the path parameter: the fastest drive along it that is
nowhere faster than the motion.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_planning.robot.model import JointGroup
from arm_planning.timing import stepped_motion
from arm_planning.timing.parameterize import RESAMPLE_DT_S
from arm_planning.timing.reachable_speeds import ReachableSpeeds
from arm_planning.timing.stepped_motion import MotionLimits
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]
CELL_S = 0.01
"""Length of the cells in which the motion is looked at."""
FEWEST_CELLS, MOST_CELLS = 100, 5000
CLOSENESS = 2e-5
"""How far the trajectory may leave these joint positions, in rad or m."""


def within_limits(
    motion: Callable[[Array], Array],
    duration_s: float,
    group: JointGroup,
    velocity_scaling: float,
    acceleration_scaling: float,
) -> TimedTrajectory:
    """Return the trajectory of a motion, slowed down where its joints could not follow.

    Args:
        motion: joint positions at times from 0 to the duration, (k,) to (k, n); rests at both ends.
        duration_s: above 0.
        group: the group.
        velocity_scaling: fraction of the velocity limits to use.
        acceleration_scaling: fraction of the acceleration limits to use.
    """
    bounds = MotionLimits(
        velocity_scaling * np.array([limit.velocity for limit in group.limits]),
        acceleration_scaling * np.array([limit.acceleration for limit in group.limits]),
        np.full(len(group.joints), np.inf),
        CLOSENESS,
    )
    lower, upper = group.lower, group.upper
    able = _slowed(lambda t: np.clip(motion(t), lower, upper), duration_s, bounds)
    # A second look sees what the cells of the first were too coarse for.
    able = _slowed(able.positions, able.duration_s, bounds)
    haste = float(bounds.acceleration[np.isfinite(bounds.acceleration)].max(initial=1.0))
    step = stepped_motion.step_for(able.duration_s, 1, haste, RESAMPLE_DT_S, bounds.closeness)
    states = able.positions(stepped_motion.steps(able.duration_s, step))
    control = stepped_motion.joined([states])
    return stepped_motion.trajectory(group.joints, control, step, bounds, RESAMPLE_DT_S)


@dataclass(frozen=True, slots=True, eq=False)
class _SlowedMotion:
    """When a motion is driven.

    Attributes:
        motion: joint positions at times of the motion, (k,) to (k, n).
        begins: start of each cell in the motion's time, (k,).
        rates: how fast its time passes there, at most 1, (k,).
        changes: how fast that changes, per s, (k,).
        times_s: when each cell begins, (k,).
        duration_s: when the last ends.
    """

    motion: Callable[[Array], Array]
    begins: Array
    rates: Array
    changes: Array
    times_s: Array
    duration_s: float

    def positions(self, times_s: Array) -> Array:
        """Return the joint positions at some times, (k, n)."""
        cell = np.searchsorted(self.times_s, times_s, side="right") - 1
        since = times_s - self.times_s[cell]
        passed = (self.rates[cell] + 0.5 * self.changes[cell] * since) * since
        return self.motion(self.begins[cell] + np.clip(passed, 0.0, self.begins[1]))


def _slowed(
    motion: Callable[[Array], Array], duration_s: float, bounds: MotionLimits
) -> _SlowedMotion:
    """Return a motion within limits, no faster than it was.

    Peaks shorter than a cell are not seen.

    Args:
        motion: joint positions at times from 0 to the duration, (k,) to (k, n); rests at both ends.
        duration_s: above 0.
        bounds: the limits.
    """
    count = min(max(math.ceil(duration_s / CELL_S), FEWEST_CELLS), MOST_CELLS)
    length = duration_s / count
    states = motion(np.linspace(0.0, duration_s, 3 * count + 1))
    tangents: Array = np.gradient(states, length / 3.0, axis=0)[::3].T
    # Two within each cell, so none mixes the accelerations of neighbouring cells.
    bends: Array = np.diff(states, 2, axis=0).T / (length / 3.0) ** 2
    limits = ReachableSpeeds.of(
        (tangents[:, :-1], bends[:, ::3]),
        (tangents[:, 1:], bends[:, 1::3]),
        np.full(count, length),
        np.repeat(bounds.velocity[:, None], count, axis=1),
        np.repeat(bounds.acceleration[:, None], count, axis=1),
    )
    limits = ReachableSpeeds(
        np.minimum(limits.top, 1.0), limits.slopes, limits.offsets, limits.reach
    )
    rates = np.sqrt(limits.fastest(1.0, 1.0))
    durations = 2.0 * length / (rates[:-1] + rates[1:])
    times = np.concatenate(([0.0], np.cumsum(durations)))
    return _SlowedMotion(
        motion,
        length * np.arange(count, dtype=np.float64),
        rates[:-1],
        np.diff(rates) / durations,
        times[:-1],
        float(times[-1]),
    )
