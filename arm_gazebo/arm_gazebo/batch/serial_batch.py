"""A few copies of one simulation, stepped one after the other.

The servo law of one robot takes less time in plain Python than as arrays of few rows.
"""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import replace

import numpy as np

from arm_gazebo.batch.copies import (
    Array,
    CommandBounds,
    Flags,
    Indices,
    check_copies,
    rows_of,
)
from arm_gazebo.physics.physics import Physics


class SerialBatch:
    """Copies of a simulation's robot and world, with its drives; see `Copies`.

    Args:
        simulation: a simulation; the copies take over its model, its start and the modes of its
            drives.
        bounds: bounds of the commands.
        copies: number of copies.
    """

    def __init__(self, simulation: Physics, bounds: CommandBounds, copies: int) -> None:
        check_copies(copies)
        self.copies = copies
        self._bounds = bounds
        servo = simulation.servo
        self._modes = [servo.mode(index) for index in range(len(servo.joints))]
        self._all = [_copy_of(simulation) for _ in range(copies)]
        self.qpos = np.zeros((copies, simulation.model.nq))
        self.qvel = np.zeros((copies, simulation.model.nv))
        self._taken: list[list[float] | None] = [None] * copies
        self.reset()

    def reset(self, copies: Indices | Sequence[int] | None = None) -> None:
        """Return copies to their start; see `Copies`."""
        for row in rows_of(copies, self.copies).tolist():
            one = self._all[row]
            one.reset()
            for index, mode in enumerate(self._modes):
                one.servo.set_mode(index, mode)
            self._taken[row] = None
            self._look(row, one)

    def advance(self, commands: Array, periods: int = 1) -> Flags:
        """Advance all copies; see `Copies`."""
        values = self._bounds.limited(commands, self.copies).tolist()
        failed = np.zeros(self.copies, dtype=bool)
        for row, (one, command) in enumerate(zip(self._all, values, strict=True)):
            if command != self._taken[row]:
                self._taken[row] = command
                for index, value in enumerate(command):
                    one.servo.command(index, value)
            for _ in range(periods):
                one.advance()
            failed[row] = bool(one.take_failures())
            self._look(row, one)
        return failed

    def link_positions(self, body: int) -> Array:
        """Return positions of a body's frame in the world, shape (copies, 3); a copy."""
        return np.array([one.observe().xpos[body] for one in self._all])

    def _look(self, row: int, one: Physics) -> None:
        self.qpos[row], self.qvel[row] = one.data.qpos, one.data.qvel


def _copy_of(simulation: Physics) -> Physics:
    built = replace(simulation.built, model=deepcopy(simulation.built.model))
    return Physics(
        built,
        simulation.timing,
        proportional_gain=simulation.servo.proportional_gain,
    )
