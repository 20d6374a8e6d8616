"""What the robot description allows the joints, and trajectories that ask for more."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_control.joint_trajectory.angles import nearest_turn
from arm_control.joint_trajectory.motion import POSITION, RESOLUTION_S, VELOCITY
from arm_control.joint_trajectory.plans import Plan
from arm_control.joint_trajectory.results import ErrorCode, Refusal
from arm_control.joint_trajectory.trajectory import Trajectory
from arm_description.robot import Robot

SAMPLES_PER_SEGMENT = 8
"""Enough to see a polynomial of degree five overshoot between its ends."""

SLACK = 1e-6
"""A value counts as outside only by more than this: planners go exactly to the limit."""

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class JointModel:
    """What the robot description says of the joints of a controller, in their order.

    Attributes:
        joints: their names.
        continuous: which turn without end, shape (n,).
        turns: whether any of them does.
        units: of their positions, rad or m.
        lower: least positions, shape (n,); -inf where there is no limit.
        upper: greatest positions, shape (n,).
        velocity: greatest speeds, shape (n,); inf where there is no limit.
    """

    joints: tuple[str, ...]
    continuous: NDArray[np.bool_]
    turns: bool
    units: tuple[str, ...]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    velocity: NDArray[np.float64]

    @classmethod
    def of(cls, robot: Robot | None, names: Sequence[str]) -> "JointModel":
        """Look joints up; one that the robot does not have is without limits."""
        known = {joint.name: joint for joint in robot.joints} if robot else {}
        joints = [known.get(name) for name in names]
        limits = [joint.limit if joint else None for joint in joints]
        continuous = [joint is not None and joint.type == "continuous" for joint in joints]
        return cls(
            tuple(names),
            np.array(continuous),
            any(continuous),
            tuple("m" if joint and joint.type == "prismatic" else "rad" for joint in joints),
            np.array([limit.lower if limit else -np.inf for limit in limits]),
            np.array([limit.upper if limit else np.inf for limit in limits]),
            np.array([limit.velocity if limit and limit.velocity else np.inf for limit in limits]),
        )

    def find_haste(
        self, trajectory: Trajectory, start: NDArray[np.float64], offset_s: float
    ) -> str | None:
        """Say which joint cannot keep up with a trajectory, None where none is known to lag.

        Cheap, for what is followed all the same: how fast a joint is at each point, and has to be
        at least to get there from the one before. A plan may ask for more in between.

        Args:
            trajectory: what is asked for.
            start: positions from which it is begun, shape (n,).
            offset_s: how long from now it starts.
        """
        due_s = trajectory.times_s + offset_s
        coming = due_s > RESOLUTION_S
        points = trajectory.motions[coming]
        if not len(points):
            return None
        start = nearest_turn(start, points[0, POSITION], self.continuous)
        ways = np.diff(np.vstack([start, points[:, POSITION]]), axis=0)
        paces = np.abs(ways) / np.diff(due_s[coming], prepend=0.0)[:, None]
        # What a point leaves open is NaN: fmax takes the other, and NaN is not greater.
        speeds = np.fmax(paces, np.abs(points[:, VELOCITY]))
        excess = np.where(speeds > self.velocity + SLACK, speeds / self.velocity, 0.0)
        row, i = np.unravel_index(np.argmax(excess), excess.shape)
        if not excess[row, i]:
            return None
        number, unit = np.flatnonzero(coming)[row] + 1, self.units[i]
        return (
            f"joint {self.joints[i]} would have to move with {speeds[row, i]:.4g} {unit}/s to be "
            f"in time at point {number} of {len(due_s)}; its velocity limit is "
            f"{self.velocity[i]:.4g} {unit}/s"
        )


@dataclass(frozen=True, slots=True)
class LimitCheck:
    """Which limits a trajectory has to keep."""

    model: JointModel
    positions: bool
    velocities: bool

    def find_excess(self, plan: Plan, times_s: Array, places: Array) -> Refusal | None:
        """Return what is wrong with a plan, None where it keeps the limits.

        Between the way points a few samples stand for the whole. A joint that is beyond a limit
        already may stay there or come back, and not go further.

        Args:
            plan: the plan.
            times_s: when its way points are due, shape (m,).
            places: where the joints are, and are told to be, shape (k, n); NaN where nobody knows.
        """
        knots_s = np.concatenate([[0.0], times_s[times_s > 0.0]])
        fractions = np.arange(SAMPLES_PER_SEGMENT) / SAMPLES_PER_SEGMENT
        between_s = knots_s[:-1, None] + np.diff(knots_s)[:, None] * fractions
        sampled_s = np.append(between_s, knots_s[-1])
        motions = np.stack([plan.sample(time_s) for time_s in sampled_s.tolist()])
        model = self.model
        if self.positions:
            position = motions[:, POSITION]
            lower = np.fmin.reduce(np.vstack([model.lower, places]))
            upper = np.fmax.reduce(np.vstack([model.upper, places]))
            outside = (position < lower - SLACK) | (position > upper + SLACK)
            for row, i in np.argwhere(outside):
                return _refusal(
                    f"The trajectory takes joint {model.joints[i]} to {position[row, i]:f}, "
                    f"outside its limits [{model.lower[i]:f}, {model.upper[i]:f}]",
                    float(sampled_s[row]),
                )
        if self.velocities:
            speed = np.abs(motions[:, VELOCITY])
            for row, i in np.argwhere(speed > model.velocity + SLACK):
                return _refusal(
                    f"The trajectory moves joint {model.joints[i]} with {speed[row, i]:f}, "
                    f"above its velocity limit of {model.velocity[i]:f}",
                    float(sampled_s[row]),
                )
        return None


def _refusal(fault: str, time_s: float) -> Refusal:
    return Refusal(ErrorCode.INVALID_GOAL, f"{fault}, {time_s:.3f} s after its start.")
