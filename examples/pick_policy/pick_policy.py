"""A small policy that picks: what the arm commands next, from its joints and the cylinder's place.

It is a network of two hidden layers in plain NumPy. It answers with commands for the next 0.4 s,
of which the first half is carried out before it is asked again. A policy that decides one command
at a time stays wherever the expert moved slowly, such as where the approach begins.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

JOINTS = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
    "gripper_controller",
)
GRIPPER = (-0.7, 0.15)
"""Closed, and wide open, in rad."""
CHUNK, CARRIED_OUT = 10, 5
"""Commands of an answer, and how many of them are carried out before the next one."""
INPUTS, OUTPUTS = len(JOINTS) + 2, CHUNK * len(JOINTS)


@dataclass(frozen=True)
class Policy:
    """The network and the scales of its inputs and outputs.

    Attributes:
        weights: of each layer, shape (inputs + 1, outputs); the last row is added.
        seen: mean and spread of the inputs, shape (2, 9).
        said: mean and spread of the outputs, shape (2, 70).
    """

    weights: tuple[Array, ...]
    seen: Array
    said: Array

    def commands(self, joints: Array, place: Array, lift: float) -> Array:
        """Return the next commands, `DECISION_S` apart, shape (10, 7).

        Args:
            joints: measured positions of the arm's joints, and the last command of the gripper,
                shape (7,).
            place: x and y of the cylinder, as the arm's base sees them.
            lift: height to lift it to.
        """
        x = (inputs(joints, place, lift) - self.seen[0]) / self.seen[1]
        changes = self.said[0] + self.said[1] * layers(self.weights, x)[-1]
        commands = joints + changes.reshape(CHUNK, len(JOINTS))
        commands[:, -1] = np.clip(commands[:, -1], *GRIPPER)
        return commands


def inputs(joints: Array, place: Array, lift: float | Array) -> Array:
    """Return what the network sees, shape (..., 9).

    The first joint counts from the cylinder's direction: a pick is the same in each direction.
    """
    x, y = place[..., 0], place[..., 1]
    turned = joints.copy()
    turned[..., 0] -= np.arctan2(y, x)
    return np.concatenate([turned, np.stack([np.hypot(x, y), lift + 0.0 * x], -1)], -1)


def layers(weights: Sequence[NDArray[Any]], x: NDArray[Any]) -> list[NDArray[Any]]:
    """Return the input and what each layer makes of it; the last layer is linear."""
    found = [x]
    for number, layer in enumerate(weights, 1):
        sums = found[-1] @ layer[:-1] + layer[-1]
        found.append(sums if number == len(weights) else np.tanh(sums))
    return found


def save(policy: Policy, path: Path) -> None:
    """Write a policy, in 32 bits."""
    named = {f"layer_{number}": layer for number, layer in enumerate(policy.weights)}
    scales = {"seen": policy.seen, "said": policy.said}
    arrays: dict[str, Any] = {n: one.astype(np.float32) for n, one in (named | scales).items()}
    np.savez_compressed(path, **arrays)


def load(path: Path) -> Policy:
    """Read a policy."""
    with np.load(path) as file:
        arrays = {name: file[name].astype(np.float64) for name in file.files}
    seen, said = arrays.pop("seen"), arrays.pop("said")
    return Policy(tuple(arrays[name] for name in sorted(arrays)), seen, said)
