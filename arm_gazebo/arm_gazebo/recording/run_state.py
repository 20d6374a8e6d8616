"""The state of a run as one row of numbers: what recordings store, hash and compare."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate, islice
from typing import Any

import mujoco
import numpy as np
import xxhash
from numpy.typing import NDArray

from arm_control.manager.controller_manager import ControllerManager
from arm_gazebo.physics.physics import Physics

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
    """Copies the state of a run as one row of numbers. Loop thread.

    A row holds the time, MuJoCo's state, and the commands and states of each robot's controller
    manager, among them the readings of its sensors. The rows of one model have one length. It is
    made between two changes of the simulation's model.

    Attributes:
        data: the arrays that it copies; a change of the model brings others.
        width: length of a row.
    """

    def __init__(self, simulation: Physics, managers: Sequence[ControllerManager]) -> None:
        self.data = simulation.data
        self._time_s = np.zeros(1)
        self._flags: list[tuple[Row, NDArray[np.bool_]]] = []
        physics = [self._numbers(getattr(simulation.data, name).reshape(-1)) for name in PARTS]
        each = (m.resources for m in managers)
        controlled = (values for r in each for values in (r.commands, r.states))
        parts = (self._time_s, *physics, *controlled)
        self._views = tuple(part.data.cast("B") for part in parts if len(part))
        self.width = sum(map(len, parts))

    def copy(self, time_s: float) -> bytes:
        """Return the present state at a simulation time, float64, shape (width,).

        After milliseconds of sleep, as before each tick, every operation costs ten times its usual
        time. A copy of all views by one call into C takes a third of what numpy takes for it.
        """
        self._time_s[0] = time_s
        for numbers, flags in self._flags:
            numbers[...] = flags
        return b"".join(self._views)

    def _numbers(self, part: NDArray[Any]) -> Row:
        """Return an array of the state; for one of flags, an array that gets them as numbers."""
        if part.dtype == np.float64:
            return part
        numbers = np.zeros(len(part))
        if len(part):
            self._flags.append((numbers, part))
        return numbers


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


def chained_hashes(previous: int, states: Iterable[bytes]) -> Iterator[int]:
    """Return for each state the hash (64 bits) of it and of all states before it.

    `previous` is the hash after the period before the first one; 0 if there is none.
    """
    return islice(accumulate(states, _chained_hash, initial=previous), 1, None)


def _chained_hash(previous: int, state: bytes) -> int:
    return xxhash.xxh3_64_intdigest(state, previous)


def _numbered(kind: str, size: int) -> Iterator[str]:
    return (f"{kind} {number}" for number in range(size))


def _per_position(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    return _per_joint(model, model.jnt_qposadr, model.nq, kind)


def _per_velocity(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    return _per_joint(model, model.jnt_dofadr, model.nv, kind)


def _per_drive(model: mujoco.MjModel, kind: str) -> Iterator[str]:
    for actuator in range(model.nactuator):
        name, count = model.actuator(actuator).name or actuator, model.actuator_ctrlnum[actuator]
        yield from _parts(f"{kind} of drive {name}", count)


def _per_joint(
    model: mujoco.MjModel, addresses: NDArray[np.int32], size: int, kind: str
) -> Iterator[str]:
    """Return a name for each number of an array that holds some numbers of each joint."""
    ends = [*addresses[1:].tolist(), size]
    for joint in range(model.njnt):
        name = model.joint(joint).name or f"number {joint}"
        count = ends[joint] - int(addresses[joint])
        yield from _parts(f"{kind} of joint {name}", count)


def _parts(name: str, count: int) -> Iterator[str]:
    """Return the name of each of the numbers of one thing."""
    return (name + (f", number {i + 1} of {count}" if count > 1 else "") for i in range(count))


_NAMED: dict[str, Callable[[mujoco.MjModel, str], Iterator[str]]] = {
    "qpos": _per_position,
    "qvel": _per_velocity,
    "qacc_warmstart": _per_velocity,
    "ctrl": _per_drive,
    "qfrc_applied": _per_velocity,
}
