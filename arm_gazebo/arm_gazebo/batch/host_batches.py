"""Copies of one simulation on this machine's processor, each bit-identical to a single one.

Many are stepped together on all cores. A few are stepped one after the other, because the servo law
of one robot takes less time in plain Python than as arrays of few rows.
"""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import replace

import mujoco
import numpy as np
from mujoco.batch import Batch
from numpy.typing import NDArray

from arm_gazebo.batch.copies import (
    Array,
    CommandBounds,
    Flags,
    Indices,
    check_copies,
    rows_of,
    start_of,
)
from arm_gazebo.drives.servo_batch import ServoBatch
from arm_gazebo.physics.contact_gate import CONTACT, FALLING_M_S, floor_clearance
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.stepped_shapes import SteppedShapes
from arm_gazebo.robot.actuation import drive_slices
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


POSITION_STAGE = mujoco.mjtStage.mjSTAGE_POS
NO_STAGE = mujoco.mjtStage.mjSTAGE_NONE


class PhysicsBatch:
    """Copies of a simulation's robot and world, with its drives; see `Copies`.

    Each copy advances as `Physics` would with the same commands, bit for bit. MuJoCo's own pool
    of threads steps the copies; the drives' law is evaluated for all of them at once.

    Args:
        simulation: a simulation; the copies take over its model, its start and the modes of its
            drives. It is not changed and can still be used.
        bounds: bounds of the commands.
        copies: number of copies, at least 1.
        threads: number of threads; 0 for one on each core.

    Raises:
        BatchError: there are no copies.
    """

    def __init__(
        self, simulation: Physics, bounds: CommandBounds, copies: int, threads: int = 0
    ) -> None:
        check_copies(copies)
        servo, self._bounds = simulation.servo, bounds
        model = deepcopy(simulation.model)
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        SteppedShapes(model).hide()
        self.copies, self._period_s = copies, simulation.timing.period_s
        self._steps = simulation.timing.steps
        # MuJoCo stores in MjData which bodies sleep, so each copy needs its own.
        self._batch = Batch(model, copies, threads, persistent=True)
        self._servo = ServoBatch(model, servo, copies)
        self._start = start_of(simulation, model)
        self._gates = ContactGates(self._batch, model, self._start, self._period_s)
        activations, controls = drive_slices(model, servo.joints)
        self._act = self._batch.bind("act")[:, activations]
        self._ctrl = self._batch.bind("ctrl")[:, controls]
        self._time = self._batch.bind("time").reshape(copies)
        self.qpos, self.qvel = self._batch.bind("qpos"), self._batch.bind("qvel")
        self._new_inertia, self._new_bias = self._batch.bind("M"), self._batch.bind("qfrc_bias")
        self._lifted = self._batch.bind("qfrc_gravcomp")
        self._inertia = np.zeros(self._new_inertia.shape)
        self._bias = np.zeros(self._new_bias.shape)
        self._link_positions = self._batch.bind("xpos")
        self._periods = np.zeros(copies, dtype=np.int64)
        self._poses_are_new = False
        self.reset()

    def reset(self, copies: Indices | Sequence[int] | None = None) -> None:
        """Return copies to their start; see `Copies`."""
        rows = rows_of(copies, self.copies)
        if not len(rows):
            return
        self._batch.reset(rows, stage=NO_STAGE)
        self.qpos[rows] = self._start.qpos
        # What the drives read in the first period.
        self._inertia[rows] = self._start.M
        self._bias[rows] = self._start.qfrc_bias - self._start.qfrc_gravcomp
        # MuJoCo sets the time to 0 when a copy becomes unstable, so no copy may start at 0.
        self._periods[rows], self._time[rows] = 1, self._period_s
        self._servo.restart(rows, self.qpos[rows], self.qvel[rows])
        self._gates.reset(rows)
        self._poses_are_new = False

    def advance(self, commands: Array, periods: int = 1) -> Flags:
        """Advance all copies; see `Copies`."""
        self._servo.command(self._bounds.limited(commands, self.copies))
        failed = np.zeros(self.copies, dtype=bool)
        for _ in range(periods):
            self._servo.update(self.qpos, self.qvel, self._inertia, self._bias)
            self._act[...] = self._servo.activations
            self._ctrl[...] = self._servo.rates
            self._gates.update()
            least_s = self._time + 0.5 * self._period_s
            self._batch.step(nstep=self._steps)
            failed |= self._time < least_s
            # Copied, because reading poses evaluates them again, and the drives read the last
            # step's.
            self._inertia[...] = self._new_inertia
            np.subtract(self._new_bias, self._lifted, self._bias)
            # As in `Physics.advance`: MuJoCo adds up its steps with their rounding errors.
            self._periods += 1
            np.multiply(self._periods, self._period_s, out=self._time)
        self._poses_are_new = False
        return failed

    def link_positions(self, body: int) -> Array:
        """Return positions of a body's frame in the world, shape (copies, 3); a copy."""
        if not self._poses_are_new:
            self._batch.forward(stage=POSITION_STAGE)
            self._poses_are_new = True
        return self._link_positions[:, body].copy()


class SerialBatch:
    """Copies of a simulation's robot and world, with its drives; see `Copies`.

    They take over the simulation's model, its start and the modes of its drives.
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
