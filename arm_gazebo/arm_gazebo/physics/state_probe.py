"""Copy and evaluate the simulation's state without changing the simulation."""

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_node.frozen import frozen


@frozen
class WorldState:
    """One state of one model.

    Attributes:
        time_s: simulation time.
        qpos: generalised positions, shape (nq,).
        qvel: generalised velocities, shape (nv,).
        mocap_pos: positions of the mocap bodies, shape (nmocap, 3).
        mocap_quat: their quaternions (w, x, y, z), shape (nmocap, 4).
    """

    time_s: float
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]
    mocap_pos: NDArray[np.float64]
    mocap_quat: NDArray[np.float64]


EVERYTHING = mujoco.mjtState.mjSTATE_INTEGRATION
WITHOUT_SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
WITH_SLEEP = int(mujoco.mjtEnableBit.mjENBL_SLEEP)


def evaluate_all(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    *functions: Callable[[mujoco.MjModel, mujoco.MjData], None],
) -> None:
    """Call MuJoCo's functions with sensors, and for sleeping bodies, too. The model's thread.

    MuJoCo does not recompute sleeping bodies. But they may have moved since the last call, and
    arrays that were made while a step hid shapes have no poses of those yet.
    """
    options = model.opt
    disabled, enabled = options.disableflags, options.enableflags
    options.disableflags = disabled & ~WITHOUT_SENSORS
    options.enableflags = enabled & ~WITH_SLEEP
    for function in functions:
        function(model, data)
    options.disableflags, options.enableflags = disabled, enabled


class StateProbe:
    """A second set of MuJoCo's arrays, updated to the present state on request. Loop thread.

    After a step, MuJoCo's accelerations, contacts and sensors belong to the state before it.
    Updating the simulation's own arrays would change its next step by a rounding error, so that
    a run would depend on who subscribes.

    Attributes:
        number: number of the present state, counted from 0.
    """

    def __init__(self) -> None:
        self.number = 0
        self._observed = self._posed = -1
        self._model: mujoco.MjModel | None = None
        self._data: mujoco.MjData

    def expire(self) -> None:
        """Note that there is a new state."""
        self.number += 1

    def restart(self, number: int = 0) -> None:
        """Note that there is a new state, which has this number."""
        self.number, self._observed, self._posed = number, -1, -1

    def observe(self, model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
        """Return the present state, valid until the next one; do not write to it.

        The model may have changed since the last call.
        """
        self._use(model)
        if self._observed != self.number:
            self._observed = self._posed = self.number
            mujoco.mj_copyState(model, data, self._data, EVERYTHING)
            evaluate_all(model, self._data, mujoco.mj_forward)
        return self._data

    def poses(self, model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
        """Return the present poses of bodies and shapes, which cost far less than `observe`.

        Nothing else in it is of the present state. For the rest see `observe`.
        """
        self._use(model)
        if self._posed != self.number:
            self._posed, probe = self.number, self._data
            probe.qpos[:] = data.qpos
            probe.mocap_pos[:], probe.mocap_quat[:] = data.mocap_pos, data.mocap_quat
            evaluate_all(model, self._data, mujoco.mj_kinematics)
        return self._data

    def _use(self, model: mujoco.MjModel) -> None:
        if self._model is not model:
            self._model, self._data = model, mujoco.MjData(model)
            self._observed = self._posed = -1
