"""The state of a run as one row of numbers: what recordings store, hash and compare."""

from collections.abc import Callable, Iterator, Sequence

import mujoco
import numpy as np
import xxhash
from numpy.typing import NDArray

from arm_control.manager.controller_manager import ControllerManager
from arm_gazebo.physics.simulation import Simulation

Row = NDArray[np.float64]

PARTS = {
    "qpos": "position",
    "qvel": "velocity",
    "act": "activation",
    "history": "history",
    "qacc_warmstart": "warm start",
    "ctrl": "control",
    "qfrc_applied": "applied force",
    "eq_active": "active equality",
    "mocap_pos": "mocap position",
    "mocap_quat": "mocap orientation",
    "userdata": "user data",
    "plugin_state": "plugin state",
    "plastic": "plastic state",
}
"""The arrays of MuJoCo's state, and what one of their numbers is called."""


class StateRow:
    """Writes the state of a run into rows. Loop thread.

    A row holds the time, MuJoCo's state, and the commands and states of each robot's controller
    manager, among them the readings of its sensors. The rows of one model have one length.

    Args:
        simulation: the simulation, between two changes of its model.
        managers: the controller managers of its robots.

    Attributes:
        width: length of a row.
    """

    def __init__(self, simulation: Simulation, managers: Sequence[ControllerManager]) -> None:
        self._data = simulation.data
        self._time_s = np.zeros(1)
        physics = (getattr(simulation.data, name).reshape(-1) for name in PARTS)
        each = (m.resources for m in managers)
        controlled = (values for r in each for values in (r.commands, r.states))
        parts = (self._time_s, *physics, *controlled)
        self._parts = [part for part in parts if len(part)]
        self.width = sum(len(part) for part in self._parts)

    def is_of(self, simulation: Simulation) -> bool:
        """Whether the simulation still has the model of these rows."""
        return self._data is simulation.data

    def write(self, row: Row) -> None:
        """Write the present state into a row, shape (width,)."""
        self._time_s[0] = self._data.time
        # With cold caches, as in every control period, one call is worth half of several.
        np.concatenate(self._parts, out=row)


def state_names(model: mujoco.MjModel, managers: Sequence[ControllerManager]) -> list[str]:
    """Return what each number of a row is, such as 'position of joint j0'."""
    names = ["time"]
    data = mujoco.MjData(model)
    for part, kind in PARTS.items():
        size = getattr(data, part).size
        names += _NAMED[part](model, kind) if part in _NAMED else _numbered(kind, size)
    for manager in managers:
        resources, robot = manager.resources, manager.name
        names += [f"command {name} of {robot}" for name in resources.command_names]
        names += [f"state {name} of {robot}" for name in resources.state_names]
    return names


def chained_hash(previous: int, row: Row) -> int:
    """Return the hash (64 bits) of a state and of all states before it.

    Args:
        previous: the hash after the period before; 0 for the first one.
        row: the state, contiguous.
    """
    return xxhash.xxh3_64_intdigest(row.data, previous)


def _numbered(kind: str, size: int) -> Iterator[str]:
    return (f"{kind} {number}" for number in range(size))


def _per_position(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    return _per_joint(model, model.jnt_qposadr, model.nq, kind)


def _per_velocity(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    return _per_joint(model, model.jnt_dofadr, model.nv, kind)


def _per_drive(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    return (f"{kind} of drive {model.actuator(i).name or i}" for i in range(model.nu))


def _per_joint(
    model: mujoco.MjModel, addresses: NDArray[np.int32], size: int, kind: str
) -> Iterator[str]:
    """Return a name for each number of an array that holds some numbers of each joint."""
    ends = [*addresses[1:].tolist(), size]
    for joint in range(model.njnt):
        name = model.joint(joint).name or f"number {joint}"
        count = ends[joint] - int(addresses[joint])
        for i in range(count):
            yield f"{kind} of joint {name}" + (f", number {i + 1} of {count}" if count > 1 else "")


_NAMED: dict[str, Callable[[mujoco.MjModel, str], Iterator[str]]] = {
    "qpos": _per_position,
    "qvel": _per_velocity,
    "qacc_warmstart": _per_velocity,
    "ctrl": _per_drive,
    "qfrc_applied": _per_velocity,
}
