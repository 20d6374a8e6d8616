"""Faults of joints and sensors on demand: joints stick; readings freeze, get noise or are NaN."""

from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from math import nan
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.mjcf.dry_friction import sticking

Values = NDArray[np.float64]

STICTION = 1e5
"""Friction in N m or N that no drive overcomes."""


class Distortion(Enum):
    """The ways in which readings can be wrong."""

    FROZEN = "frozen"
    NOISY = "noisy"
    NAN = "nan"


class PhysicsFaults:
    """The present faults of one simulation. Loop thread only.

    Args:
        joint_address: returns the index of a joint's first degree of freedom.
    """

    def __init__(self, model: mujoco.MjModel, joint_address: Callable[[str], int]) -> None:
        self._model = model
        self._joint_address = joint_address
        self._stalled: dict[str, tuple[float, Values, Values]] = {}
        self._distortions: dict[tuple[str, Distortion], tuple[float, int]] = {}
        self._frozen: dict[str, float] = {}

    def stall(self, joint: str) -> None:
        """Make a joint stick where it is."""
        address, model = self._joint_address(joint), self._model
        if joint not in self._stalled:
            self._stalled[joint] = (
                float(model.dof_frictionloss[address]),
                model.dof_solimp[address].copy(),
                model.dof_solref[address].copy(),
            )
        model.dof_frictionloss[address] = STICTION
        sticking(model.opt.timestep).apply(model, address)

    def free(self, joint: str) -> None:
        """Let a joint move again; has no effect if it does not stick."""
        if joint in self._stalled:
            address = self._joint_address(joint)
            friction, impedance, reference = self._stalled.pop(joint)
            self._model.dof_frictionloss[address] = friction
            self._model.dof_solimp[address] = impedance
            self._model.dof_solref[address] = reference

    def rebind(self, model: mujoco.MjModel) -> None:
        """Make the same joints stick in another model."""
        self._model = model
        for joint in list(self._stalled):
            del self._stalled[joint]
            self.stall(joint)

    def distort(self, name: str, kind: Distortion, deviation: float, seed: int) -> None:
        """Make readings wrong from now on.

        `name` is a joint, a sensor, or one of its channels, such as j0/position. The standard
        deviation of the noise is in the unit of the reading.
        """
        self._distortions[name, kind] = deviation, seed

    def clear(self, name: str, kind: Distortion) -> None:
        """Make readings correct again; has no effect if they already are."""
        self._distortions.pop((name, kind), None)
        if not any(kind is Distortion.FROZEN for _, kind in self._distortions):
            self._frozen.clear()

    @property
    def present(self) -> dict[str, Any] | None:
        """The faults that last, as plain data for `resume`; None if there are none."""
        if not self._stalled and not self._distortions:
            return None
        return {
            "stalled": list(self._stalled),
            "distorted": [
                (name, kind.value, deviation, seed)
                for (name, kind), (deviation, seed) in self._distortions.items()
            ],
            "frozen": dict(self._frozen),
        }

    def resume(self, present: Mapping[str, Any]) -> None:
        """Begin the faults of `present`; frozen readings keep their values."""
        for joint in present["stalled"]:
            self.stall(joint)
        for name, kind, deviation, seed in present["distorted"]:
            self.distort(name, Distortion(kind), deviation, seed)
        self._frozen.update(present["frozen"])

    def apply(self, channels: Sequence[str], readings: Values, number: int) -> None:
        """Apply the faults to the readings (n,) of channels such as j0/position, in place.

        The number of the state determines the noise.
        """
        if not self._distortions:
            return
        for (name, kind), (deviation, seed) in self._distortions.items():
            for index, channel in enumerate(channels):
                if channel == name or channel.startswith(f"{name}/"):
                    readings[index] = self._wrong(
                        channel, float(readings[index]), kind, deviation, (seed, number)
                    )

    def _wrong(
        self, channel: str, value: float, kind: Distortion, deviation: float, key: tuple[int, int]
    ) -> float:
        match kind:
            case Distortion.FROZEN:
                return self._frozen.setdefault(channel, value)
            case Distortion.NOISY:
                # Each channel has its own noise, which does not depend on the other channels.
                words = (*key, *channel.encode())
                return value + deviation * float(np.random.default_rng(words).standard_normal())
            case Distortion.NAN:
                return nan
