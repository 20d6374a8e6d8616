"""Skip collision detection of the copies of a batch that are well above a bare floor."""

import mujoco
import numpy as np
from mujoco.batch import Batch
from numpy.typing import NDArray

from arm_gazebo.physics.contact_gate import CONTACT, FALLING_M_S, floor_clearance
from arm_node.index_slice import as_slice


class ContactGates:
    """The `ContactGate` of each copy of a batch.

    Args:
        batch: the batch; its option flags become those of single copies where that is useful.
        model: its model, with collision detection on.
        start: a state of it with valid geom positions.
        period_s: time between two calls of `update`.
    """

    def __init__(
        self, batch: Batch, model: mujoco.MjModel, start: mujoco.MjData, period_s: float
    ) -> None:
        clearance = floor_clearance(model, start, period_s)
        self._useful = clearance.useful
        if not self._useful:
            return
        self._ticks, self._until_check = clearance.ticks, 0
        self._on = model.opt.disableflags
        self._off = model.opt.disableflags | int(CONTACT)
        self._flags = batch.expand("opt.disableflags").reshape(-1)
        self._heights = batch.bind("geom_xpos")[:, :, 2]
        self._velocities = batch.bind("qvel")
        self._moving, self._needed = as_slice(clearance.moving), clearance.needed
        self._free = as_slice(clearance.free)

    def reset(self, rows: NDArray[np.intp]) -> None:
        """Detect collisions of copies that were reset."""
        if self._useful:
            self._flags[rows] = self._on
            # The positions of their shapes are known only after their next step.
            self._until_check = 1

    def update(self) -> None:
        """Check which copies are near the floor; called once in each control period."""
        if not self._useful:
            return
        self._until_check -= 1
        if self._until_check < 0:
            self._until_check = self._ticks - 1
            clear = (self._heights[:, self._moving] > self._needed).all(axis=1)
            clear &= (self._velocities[:, self._free] > -FALLING_M_S).all(axis=1)
            self._flags[:] = np.where(clear, self._off, self._on)
