"""What every kind of batch offers: copies of a robot in its world, under commands to its drives."""

from collections.abc import Sequence
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.errors import BatchError
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.physics.physics import Physics

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.intp]


class Copies(Protocol):
    """Copies of a simulation, stepped together. One thread calls it.

    Controllers, sensors and cameras are left out: commands go to the drives directly.

    Attributes:
        copies: number of copies.
        qpos: present positions, shape (copies, nq); do not write to it.
        qvel: present velocities, shape (copies, nv); do not write to it.
    """

    copies: int
    qpos: Array
    qvel: Array

    def reset(self, copies: Indices | Sequence[int] | None = None) -> None:
        """Return the copies with these indices to their start, at rest; None for all."""
        ...

    def advance(self, commands: Array, periods: int = 1) -> Flags:
        """Advance all copies by control periods under one command.

        Args:
            commands: one for each driven joint of each copy in the unit of its mode, shape
                (copies, joints); those beyond the joints' limits are limited.
            periods: control periods.

        Returns:
            Which copies became unstable, shape (copies,); reset these.

        Raises:
            BatchError: the commands have the wrong shape, or are not finite.
        """
        ...

    def link_positions(self, body: int) -> Array:
        """Return positions of a body's frame in the world, shape (copies, 3); a copy."""
        ...


class CommandBounds:
    """The lowest and highest command of each drive, from the interfaces that are claimed."""

    def __init__(self, simulation: Physics, hardware: Sequence[SimulatedHardware]) -> None:
        count = len(simulation.servo.joints)
        self.lower, self.upper = np.full(count, -np.inf), np.full(count, np.inf)
        for component in hardware:
            for drive, bounds in component.command_bounds().items():
                self.lower[drive], self.upper[drive] = bounds

    def limited(self, commands: Array, copies: int) -> Array:
        """Return commands within the bounds.

        Raises:
            BatchError: their shape is not (copies, joints), or they are not finite.
        """
        shape = (copies, len(self.lower))
        values = np.ascontiguousarray(commands, dtype=np.float64)
        if values.shape != shape:
            raise BatchError(f"commands need the shape {shape}, not {values.shape}")
        if not np.isfinite(values).all():
            raise BatchError("commands need finite values; these have a NaN or an infinity")
        return np.minimum(np.maximum(values, self.lower), self.upper)


def check_copies(copies: int) -> None:
    """Check a number of copies.

    Raises:
        BatchError: it is below 1.
    """
    if copies < 1:
        raise BatchError(f"a batch needs at least 1 copy, not {copies}")


def rows_of(copies: Indices | Sequence[int] | None, count: int) -> Indices:
    """Return the indices of some of `count` copies; None for all."""
    return np.arange(count) if copies is None else np.asarray(copies, dtype=np.intp)


def start_of(simulation: Physics, model: mujoco.MjModel) -> mujoco.MjData:
    """Return the state in which copies of a simulation with this model start."""
    start = mujoco.MjData(model)
    start.qpos[:] = simulation.built.qpos
    mujoco.mj_forward(model, start)
    return start
