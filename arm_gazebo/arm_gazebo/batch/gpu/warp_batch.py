"""Copies of one simulation on a GPU, by MuJoCo Warp; their states are close to those on the host.

MuJoCo Warp computes in 32 bits and sums in another order, so the bits differ. A control period, the
drives' law and the physics steps, is one recorded graph, which the GPU does without the host.
"""

from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import mujoco
import mujoco_warp
import numpy as np
import warp as wp
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
from arm_gazebo.batch.gpu.servo_warp import ServoWarp
from arm_gazebo.batch.gpu_device import GPU, HOST_COMPILED, explained
from arm_gazebo.errors import BatchError
from arm_gazebo.physics.physics import Physics

wp.set_module_options({"enable_backward": False})


@wp.kernel
def write_rows(
    row: wp.array[wp.float32], rows: wp.array[wp.int32], array: wp.array2d[wp.float32]
) -> None:
    """Write one row to several rows of an array."""
    each, column = wp.tid()
    array[rows[each], column] = row[column]


@wp.kernel
def read_column(array: wp.array2d[wp.vec3], column: wp.int32, result: wp.array[wp.vec3]) -> None:
    """Read a column of vectors."""
    copy = wp.tid()
    result[copy] = array[copy, column]


@wp.kernel
def subtract(
    array: wp.array2d[wp.float32], part: wp.array2d[wp.float32], result: wp.array2d[wp.float32]
) -> None:
    """Subtract one array from another."""
    copy, column = wp.tid()
    result[copy, column] = array[copy, column] - part[copy, column]


LEAST_CONTACTS = 48
CONTACTS = 32
CONTACTS_PER_TREE = 12
"""A box on the floor has 4 contacts, and as many with the fingers and with the box beside it."""
CONTACTS_OF_SURFACE = 256
"""More contacts where there are height fields or soft bodies."""
EQUALITY_ROWS = {
    mujoco.mjtEq.mjEQ_CONNECT: 3,
    mujoco.mjtEq.mjEQ_WELD: 6,
}
"""Rows of the equality constraints; all others have one."""


@dataclass(frozen=True, slots=True)
class Room:
    """Room for one copy.

    Attributes:
        contacts: contacts; a copy may use the room of others.
        rows: rows of all constraints: equalities, friction, limits and contacts.
    """

    contacts: int
    rows: int


def room_of(model: mujoco.MjModel) -> Room:
    """Return the room for copies of a model."""
    contacts = max(LEAST_CONTACTS, CONTACTS + CONTACTS_PER_TREE * model.ntree)
    if model.nhfield or model.nflex:
        contacts += CONTACTS_OF_SURFACE
    dimension = int(max([1, *model.geom_condim, *model.pair_dim]))
    if model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL and dimension > 1:
        dimension = 2 * (dimension - 1)
    rows = sum(EQUALITY_ROWS.get(kind, 1) for kind in model.eq_type.tolist())
    rows += int((model.dof_frictionloss > 0.0).sum() + (model.tendon_frictionloss > 0.0).sum())
    # A joint or tendon may be at both of its limits.
    rows += 2 * int(model.jnt_limited.sum() + model.tendon_limited.sum())
    return Room(contacts, rows + dimension * contacts)


def check_overflow(overflow: NDArray[np.int32], room: Room) -> None:
    """Check that the room sufficed, by MuJoCo Warp's flags of each copy, shape (copies,).

    Raises:
        BatchError: it did not, so that contacts are missing in these copies.
    """
    kinds = mujoco_warp.OverflowType
    # The others say that a solver stopped at its last iteration, which does not disturb MuJoCo.
    missing = kinds.NEFC | kinds.NJMAX_NNZ | kinds.BROADPHASE | kinds.NARROWPHASE
    missing |= kinds.CCD | kinds.HFIELD
    count = int(((overflow & int(missing)) != 0).sum())
    if count:
        raise BatchError(
            f"{count} copies have more contacts than there is room for on the device: "
            f"{room.contacts} contacts and {room.rows} rows of constraints for each; "
            "device='host' has no such limit"
        )


SLEEP = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
CONTACT = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
LARGEST = float(mujoco.mjMAXVAL)
"""MuJoCo, too, counts a state with a larger number as unstable."""
STATE = (
    "qpos",
    "qvel",
    "act",
    "ctrl",
    "qacc_warmstart",
    "M",
    "qfrc_bias",
    "qfrc_gravcomp",
    "history",
    "plastic",
)
"""What the next steps and the drives depend on, apart from the time."""


class WarpBatch:
    """Copies of a simulation's robot and world, with its drives; see `Copies`.

    A copy that becomes unstable returns to its start at once.

    Args:
        simulation: a simulation; the copies take over its model, its start and the modes of its
            drives.
        bounds: bounds of the commands.
        copies: number of copies.
        device: Warp's name of a device that `check_device` accepts; "cpu" is for comparisons, it is
            slow.

    Raises:
        BatchError: the device has too little memory, or MuJoCo Warp cannot simulate something in
            the model.
    """

    def __init__(
        self, simulation: Physics, bounds: CommandBounds, copies: int, device: str = GPU
    ) -> None:
        check_copies(copies)
        self.copies, self._bounds, self._device = copies, bounds, device
        self._steps = simulation.timing.steps
        model = _without_sleep(simulation.model)
        self._room = room_of(model)
        self._start, self._bodies = start_of(simulation, model), range(model.nbody)
        with explained(copies, device), wp.ScopedDevice(device):
            self._model = mujoco_warp.put_model(model)
            # `check_overflow` reports it.
            self._model.opt.warn_overflow = 0
            room = {"nconmax": self._room.contacts, "njmax": self._room.rows}
            self._data = mujoco_warp.make_data(model, nworld=copies, **room)
            self._servo = ServoWarp(model, simulation.servo, copies, self._start.qpos, device)
            self._starts = self._find_starts()
            lifts = model.ngravcomp
            self._bias = wp.empty_like(self._data.qfrc_bias) if lifts else self._data.qfrc_bias
            self.qpos, self.qvel = np.zeros((copies, model.nq)), np.zeros((copies, model.nv))
            pinned = device != HOST_COMPILED
            self._mirrors = [
                (field, wp.empty(field.shape, dtype=field.dtype, device="cpu", pinned=pinned))
                for field in (self._data.qpos, self._data.qvel, self._data.overflow)
            ]
            self._column = wp.zeros(copies, dtype=wp.vec3)
            self._places: dict[int, Array] = {}
            self.reset()
            self._advance, self._place = self._recorded(self._period), self._recorded(self._look)
            # Recording them has moved the copies.
            self.reset()

    def reset(self, copies: Indices | Sequence[int] | None = None) -> None:
        """Return copies to their start; see `Copies`."""
        # No index beyond the copies may reach the device, where nothing checks it.
        rows = np.arange(self.copies)[rows_of(copies, self.copies)]
        if not len(rows):
            return
        self.qpos[rows], self.qvel[rows] = self._start.qpos, 0.0
        indices = wp.array(rows.astype(np.int32), dtype=wp.int32, device=self._device)
        for field, row in self._starts:
            shape = (len(rows), len(row))
            wp.launch(write_rows, shape, inputs=[row, indices, field], device=self._device)
        self._servo.restart(indices)
        self._places.clear()

    def advance(self, commands: Array, periods: int = 1) -> Flags:
        """Advance all copies; see `Copies`.

        Raises:
            BatchError: see `Copies`, or there are more contacts than the device has room for.
        """
        values = self._bounds.limited(commands, self.copies)
        with explained(self.copies, self._device):
            self._servo.command(values)
            for _ in range(periods):
                self._advance()
            qpos, qvel, overflow = self._read()
        self._places.clear()
        self.qpos[...], self.qvel[...] = qpos, qvel
        # Comparisons with NaN are false.
        stable = (np.abs(self.qpos) <= LARGEST).all(axis=1)
        stable &= (np.abs(self.qvel) <= LARGEST).all(axis=1)
        if overflow.any():
            self._data.overflow.zero_()
            # The links of an unstable copy are anywhere, so it can have any number of contacts.
            check_overflow(overflow[stable], self._room)
        failed: Flags = np.logical_not(stable)
        self.reset(np.flatnonzero(failed))
        return failed

    def link_positions(self, body: int) -> Array:
        """Return positions of a body's frame in the world, shape (copies, 3); a copy."""
        body = self._bodies[body]
        if not self._places:
            self._place()
        if body not in self._places:
            inputs = [self._data.xpos, body, self._column]
            wp.launch(read_column, self.copies, inputs=inputs, device=self._device)
            self._places[body] = self._column.numpy().astype(np.float64)
        return self._places[body].copy()

    def _period(self) -> None:
        """Do a control period."""
        data = self._data
        if self._bias is not data.qfrc_bias:
            inputs = [data.qfrc_bias, data.qfrc_gravcomp, self._bias]
            wp.launch(subtract, self._bias.shape, inputs=inputs, device=self._device)
        self._servo.update(data.qpos, data.qvel, data.M, self._bias, data.act, data.ctrl)
        for _ in range(self._steps):
            mujoco_warp.step(self._model, data)

    def _look(self) -> None:
        """Find out where the bodies are."""
        mujoco_warp.kinematics(self._model, self._data)

    def _recorded(self, work: Callable[[], None]) -> Callable[[], None]:
        """Return work for the device as one recorded graph, where that is possible."""

        def here() -> None:
            with wp.ScopedDevice(self._device):
                work()

        if self._device == HOST_COMPILED:
            return here
        # Compiles the kernels: not every driver can load them while it records.
        here()
        with wp.ScopedCapture(self._device) as capture:
            work()
        graph = capture.graph
        return lambda: wp.capture_launch(graph)

    def _read(self) -> list[Any]:
        """Return positions, velocities and overflow flags on the host, when the device is done."""
        for field, mirror in self._mirrors:
            wp.copy(mirror, field)
        wp.synchronize_device(self._device)
        return [mirror.numpy() for _, mirror in self._mirrors]

    def _find_starts(self) -> list[tuple[Any, Any]]:
        """Return the arrays of the state, and the row of each at the start."""
        start, data = self._start, self._data
        known = {name: getattr(start, name) for name in ("qpos", "M", "qfrc_bias", "qfrc_gravcomp")}
        fields = [(getattr(data, name), known.get(name)) for name in STATE]
        fields.append((data.time.reshape((self.copies, 1)), None))
        return [
            (field, wp.array(field.numpy()[0] if row is None else row, dtype=wp.float32))
            for field, row in fields
            if field.size
        ]


def _without_sleep(model: mujoco.MjModel) -> mujoco.MjModel:
    """Return a model with collision detection, in which nothing sleeps.

    MuJoCo Warp does not know things that sleep from the start.
    """
    model = deepcopy(model)
    model.opt.disableflags &= ~CONTACT
    model.opt.enableflags &= ~SLEEP
    model.tree_sleep_policy[:] = mujoco.mjtSleepPolicy.mjSLEEP_AUTO
    return model
