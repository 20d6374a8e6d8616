"""Copies of one simulation on a GPU, by MuJoCo Warp; their states are close to those on the host.

MuJoCo Warp computes in 32 bits and sums in another order, so the bits differ. The drives' law is
evaluated on the host, as for `PhysicsBatch`.
"""

from collections.abc import Callable, Sequence
from copy import deepcopy
from importlib import import_module
from typing import Any

import mujoco
import numpy as np

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
from arm_gazebo.errors import BatchError
from arm_gazebo.physics.simulation import Simulation

GPU = "cuda"
SLEEP = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
CONTACT = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)


class WarpBatch:
    """Copies of a simulation's robot and world, with its drives; see `Copies`.

    Args:
        simulation: a simulation; the copies take over its model, its start and the modes of its
            drives.
        bounds: bounds of the commands.
        copies: number of copies.
        device: Warp's name of a device; "cpu" is for comparisons, it is slow.

    Raises:
        BatchError: MuJoCo Warp is not installed, there is no GPU, or it cannot simulate something
            in the model.
    """

    def __init__(
        self, simulation: Simulation, bounds: CommandBounds, copies: int, device: str = GPU
    ) -> None:
        check_copies(copies)
        self._warp, self._engine = _packages(device)
        self.copies, self._bounds, self._device = copies, bounds, device
        self._steps = simulation.timing.steps
        model = deepcopy(simulation.model)
        model.opt.disableflags &= ~CONTACT
        # No sleep on the host, because MuJoCo Warp has none on the device.
        model.opt.enableflags &= ~SLEEP
        self._servo = ServoBatch(model, simulation.servo, copies)
        self._start = start_of(simulation, model)
        with self._warp.ScopedDevice(device):
            try:
                self._model = self._engine.put_model(model)
            except (NotImplementedError, ValueError) as error:
                raise BatchError(f"MuJoCo Warp cannot simulate this model: {error}") from error
            self._data = self._engine.make_data(model, nworld=copies)
        self.qpos = np.zeros((copies, model.nq))
        self.qvel = np.zeros((copies, model.nv))
        self._inertia = np.zeros((copies, model.nC))
        self._bias = np.zeros((copies, model.nv))
        actuators = [joint.actuator or 0 for joint in simulation.servo.joints]
        self._actuators = np.array(actuators, dtype=np.intp)
        self._activations = model.actuator_actadr[self._actuators]
        self._act = np.zeros((copies, model.na), dtype=np.float32)
        self._ctrl = np.zeros((copies, model.nu), dtype=np.float32)
        self._launch: Callable[[], None] | None = None
        self.reset()

    def reset(self, copies: Indices | Sequence[int] | None = None) -> None:
        """Return copies to their start; see `Copies`."""
        rows = rows_of(copies, self.copies)
        mask = np.zeros(self.copies, dtype=bool)
        mask[rows] = True
        self.qpos[rows], self.qvel[rows] = self._start.qpos, 0.0
        self._inertia[rows], self._bias[rows] = self._start.M, self._start.qfrc_bias
        with self._warp.ScopedDevice(self._device):
            self._engine.reset_data(self._model, self._data, self._warp.array(mask, dtype=bool))
            self._data.qpos.assign(self.qpos.astype(np.float32))
        self._servo.restart(rows, self.qpos[rows], self.qvel[rows])

    def advance(self, commands: Array, periods: int = 1) -> Flags:
        """Advance all copies; see `Copies`.

        Raises:
            BatchError: see `Copies`, or there are more contacts than the device has room for.
        """
        self._servo.command(self._bounds.limited(commands, self.copies))
        data = self._data
        for _ in range(periods):
            self._servo.update(self.qpos, self.qvel, self._inertia, self._bias)
            self._act[:, self._activations] = self._servo.activations
            self._ctrl[:, self._actuators] = self._servo.rates
            data.act.assign(self._act)
            data.ctrl.assign(self._ctrl)
            self._step()
            for mine, theirs in (
                (self.qpos, data.qpos),
                (self.qvel, data.qvel),
                (self._inertia, data.M),
                (self._bias, data.qfrc_bias),
            ):
                mine[...] = theirs.numpy()
        if data.overflow.numpy().any():
            raise BatchError("the copies have more contacts than MuJoCo Warp has room for")
        return np.array(~np.isfinite(self.qpos).all(axis=1))

    def link_positions(self, body: int) -> Array:
        """Return positions of a body's frame in the world, shape (copies, 3); a copy."""
        with self._warp.ScopedDevice(self._device):
            self._engine.kinematics(self._model, self._data)
        return self._data.xpos.numpy()[:, body].astype(np.float64)

    def _step(self) -> None:
        """Do the physics steps of a control period; on a GPU as one recorded graph."""
        if self._launch is None:
            self._launch = self._recorded() if self._device != "cpu" else self._steps_alone
        self._launch()

    def _steps_alone(self) -> None:
        with self._warp.ScopedDevice(self._device):
            for _ in range(self._steps):
                self._engine.step(self._model, self._data)

    def _recorded(self) -> Callable[[], None]:
        with self._warp.ScopedDevice(self._device), self._warp.ScopedCapture() as capture:
            for _ in range(self._steps):
                self._engine.step(self._model, self._data)
        graph = capture.graph
        # Recording runs nothing, so the state is still the one before the first launch.
        return lambda: self._warp.capture_launch(graph)


def _packages(device: str) -> tuple[Any, Any]:
    """Return warp and mujoco_warp.

    Raises:
        BatchError: they are not installed, or there is no such device.
    """
    try:
        warp, engine = import_module("warp"), import_module("mujoco_warp")
    except ImportError as error:
        raise BatchError(
            f"copies on a GPU need MuJoCo Warp; pip install 'arm-suite[gpu]' ({error})"
        ) from error
    if device != "cpu" and not warp.get_cuda_device_count():
        raise BatchError("copies on a GPU need a GPU that CUDA finds, and there is none")
    return warp, engine
