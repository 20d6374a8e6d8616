"""The set-points of the same joints in many copies of a simulation, bit-identical to a single one.

Each function is the array form of the method of that name in `setpoint` or `driven_joint`: the same
operations in the same order, so that every number has the same bits.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_gazebo.drives.driven_joint import MAX_INTERVAL_S
from arm_gazebo.drives.setpoint import LANDING_SLACK, LATE_BRAKING

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LONG_AGO = -1_000_000


@dataclass(frozen=True, slots=True)
class CommandStreams:
    """The `CommandStream` of every joint of every copy, arrays of shape (copies, joints).

    Attributes:
        target: positions of the targets at the end of this control period.
        velocity: velocities of the targets.
        command: the last commands.
        left: control periods that remain until a target arrives at its command.
        last_change: control period of the last command.
    """

    target: Array
    velocity: Array
    command: Array
    left: Integers
    last_change: Integers

    @staticmethod
    def at(positions: Array) -> "CommandStreams":
        """Return streams that rest at positions."""
        return CommandStreams(
            positions.copy(),
            np.zeros(positions.shape),
            positions.copy(),
            np.zeros(positions.shape, dtype=np.int64),
            np.full(positions.shape, LONG_AGO, dtype=np.int64),
        )

    def arrays(self) -> tuple[NDArray[np.generic], ...]:
        """Return the arrays, in the order of the attributes."""
        return self.target, self.velocity, self.command, self.left, self.last_change

    def put(self, rows: NDArray[np.intp], other: "CommandStreams") -> None:
        """Replace the streams of some copies."""
        for mine, new in zip(self.arrays(), other.arrays(), strict=True):
            mine[rows] = new

    def take(self, commands: Array, ticks: Integers, period_s: float) -> None:
        """Take the commands of a control period; see `CommandStream.command`.

        A command equal to the last one has no effect. Shapes: commands (copies, joints), the
        numbers of the copies' control periods (copies, 1).
        """
        changed = commands != self.command
        if not changed.any():
            return
        interval = ticks - self.last_change
        step = changed & (interval * period_s > MAX_INTERVAL_S)
        sample = changed & ~step
        np.copyto(self.command, commands, where=changed)
        np.copyto(self.last_change, np.broadcast_to(ticks, changed.shape), where=changed)
        np.copyto(self.left, np.maximum(interval, 1), where=sample)
        self.left[step] = 0
        # `left` may be 0 where no sample arrived; those quotients are not used.
        periods = np.maximum(self.left, 1) * period_s
        np.copyto(self.velocity, (commands - self.target) / periods, where=sample)
        np.copyto(self.target, commands, where=step)
        self.velocity[step] = 0.0

    def advance(self, rows: NDArray[np.bool_] | None, period_s: float) -> None:
        """Advance copies, those in `rows` (copies, 1) or all; see `CommandStream.advance`."""
        if not (self.left.any() or self.velocity.any()):
            return
        moves, arrives, rests = self.left > 1, self.left == 1, self.left == 0
        if rows is not None:
            moves, arrives, rests = moves & rows, arrives & rows, rests & rows
        np.copyto(self.target, self.target + self.velocity * period_s, where=moves)
        np.copyto(self.target, self.command, where=arrives)
        self.velocity[rests] = 0.0
        np.subtract(self.left, moves | arrives, out=self.left)


def approach(
    position: Array,
    start_velocity: Array,
    target: Array,
    target_velocity: Array | float,
    speed: Array,
    acceleration: Array,
    braking: Array,
    period_s: float,
) -> tuple[Array, Array]:
    """Return positions and velocities after a control period; see `Setpoint.approach`.

    All arrays have the shape (copies, joints), or are broadcast to it.
    """
    followed = np.minimum(np.maximum(target_velocity, -speed), speed)
    gap = target - position
    distance = target - followed * period_s - position
    velocity = start_velocity - followed
    change, brake = acceleration * period_s, braking * period_s
    landing = np.where(followed != 0.0, change, brake)
    reach = speed * period_s * LANDING_SLACK
    near = (np.abs(velocity) <= landing) & (np.abs(gap) <= reach)
    miss = distance - 0.5 * velocity * period_s
    lands = near & (np.abs(miss) <= 0.25 * landing * period_s)
    backwards = (distance < 0.0) | ((distance == 0.0) & (velocity > 0.0))
    sign = np.where(backwards, -1.0, 1.0)
    # A product with 1 or -1 is exact.
    distance, velocity = distance * sign, velocity * sign
    root = brake * (0.25 * brake - velocity) + 2.0 * braking * distance
    fastest = np.where(root > 0.0, np.sqrt(np.maximum(root, 0.0)) - 0.5 * brake, -np.inf)
    cruise = speed - sign * followed
    hardest = np.where(fastest > cruise, change, np.maximum(LATE_BRAKING * brake, change))
    fastest = np.minimum(fastest, cruise)
    fastest = np.maximum(np.minimum(fastest, velocity + change), velocity - hardest)
    end = followed + sign * fastest
    moved = position + 0.5 * period_s * (start_velocity + end)
    return np.where(lands, target, moved), np.where(lands, followed, end)


def held_back(
    position: Array, velocity: Array, joint_position: Array, joint_velocity: Array, slack: Array
) -> tuple[Array, Array]:
    """Return set-points that do not run ahead of joints that something holds or drags.

    See `DrivenJoint.plan`. Shapes: (copies, joints), but (joints,) of `slack`.
    """
    lead = position - joint_position
    ahead, behind = lead > slack, lead < -slack
    if not (ahead.any() or behind.any()):
        return position, velocity
    forward, backward = np.maximum(joint_velocity, 0.0), np.minimum(joint_velocity, 0.0)
    position = np.where(ahead, joint_position + slack, position)
    position = np.where(behind, joint_position - slack, position)
    velocity = np.where(ahead, np.minimum(velocity, forward), velocity)
    return position, np.where(behind, np.maximum(velocity, backward), velocity)
