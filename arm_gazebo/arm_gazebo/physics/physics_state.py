"""Save and restore everything in MuJoCo's model and state that changes while it runs."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.physics.state_probe import EVERYTHING
from arm_gazebo.physics.state_transfer import DRIVE_ARRAYS

MODEL_ARRAYS = (*DRIVE_ARRAYS, "dof_armature", "dof_M0")
"""Fields of the model that the drives set."""
AWAKE_COUNTS = ("nbody_awake", "nparent_awake", "ntree_awake", "nv_awake")


class PhysicsState:
    """The running part of one model and its state. Loop thread.

    After a step, MuJoCo's derived quantities (inertias, gravity, poses of shapes) belong to the
    state before it. The drives read them, and MuJoCo itself keeps those of sleeping bodies. So the
    integration state alone would not let a run continue with the same bits, and all arrays are
    saved.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Refer to a model and its state."""
        self._model = model
        self._data = data
        self._names: tuple[str, ...] = ()
        self._integration = np.empty(mujoco.mj_stateSize(model, EVERYTHING))

    def save(self) -> dict[str, Any]:
        """Return the arrays themselves, by name; encode them at once."""
        data, model = self._data, self._model
        if not self._names:
            self._names = _array_names(mujoco.MjData(model))
        return {
            "time": data.time,
            "arrays": {name: getattr(data, name) for name in self._names},
            "awake": [getattr(data, name) for name in AWAKE_COUNTS],
            "model": {name: getattr(model, name) for name in MODEL_ARRAYS},
        }

    def load(self, state: dict[str, Any]) -> None:
        """Restore saved arrays of the same model."""
        for name, values in state["model"].items():
            getattr(self._model, name)[...] = values
        self._load_data(state)
        # Contacts are not saved; they are computed again from this state for whatever shows them.
        mujoco.mj_forward(self._model, self._data)
        self._load_data(state)

    def _load_data(self, state: dict[str, Any]) -> None:
        data = self._data
        for name, values in state["arrays"].items():
            getattr(data, name)[...] = values
        # With the counts of another state MuJoCo looks for contacts between sleeping bodies, and
        # ends with an error if it finds one.
        for name, count in zip(AWAKE_COUNTS, state["awake"], strict=True):
            setattr(data, name, count)
        data.time = state["time"]

    def integration(self) -> NDArray[np.float64]:
        """Return the numbers that the next step depends on; valid until the next call."""
        mujoco.mj_getState(self._model, self._data, self._integration, EVERYTHING)
        return self._integration


def _array_names(fresh: mujoco.MjData) -> tuple[str, ...]:
    """Return the names of the arrays whose size does not depend on the contacts."""
    return tuple(
        name
        for name in dir(fresh)
        if not name.startswith("_")
        and isinstance(values := getattr(fresh, name), np.ndarray)
        and values.size
    )
