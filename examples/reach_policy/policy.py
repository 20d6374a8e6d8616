"""A small policy that moves the 4-DOF arm's gripper to a point: 84 weights.

It sees the joints and the vector to the goal, and answers with the next step of each joint.
"""

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

JOINTS = 4
WAYS = 3
"""Parts of the way to the goal: ahead, aside and up, as the turntable sees it."""
ANGLES = 7
"""Factors of each part: 1, and the sine and cosine of three links' angles."""
WEIGHTS = JOINTS * WAYS * ANGLES
NEAR_M = 0.1
"""Scale of the way to the goal: at this distance an input is 1."""


def act(weights: Array, position: NDArray[np.floating], error: NDArray[np.floating]) -> Array:
    """Return actions from -1 to 1 for the environment's actions "step", shape (..., 4).

    The inputs are the components of the vector to the goal, in the turntable's frame, each
    multiplied by 1 and by the sine and the cosine of the angle of each link. The weights say how
    far each joint turns for each input.

    Args:
        weights: shape (..., 84).
        position: positions of the joints in rad, shape (..., 4).
        error: vector from the gripper to the goal in m, shape (..., 3).
    """
    turn, links = position[..., :1], np.cumsum(position[..., 1:], axis=-1)
    ahead = np.cos(turn) * error[..., :1] + np.sin(turn) * error[..., 1:2]
    aside = np.cos(turn) * error[..., 1:2] - np.sin(turn) * error[..., :1]
    way = np.concatenate([ahead, aside, error[..., 2:]], axis=-1) / NEAR_M
    angles = np.concatenate([np.ones_like(turn), np.sin(links), np.cos(links)], axis=-1)
    inputs = (way[..., :, None] * angles[..., None, :]).reshape(*way.shape[:-1], -1)
    shaped = weights.reshape(*weights.shape[:-1], JOINTS, WAYS * ANGLES)
    return np.tanh(np.einsum("...ij,...j->...i", shaped, inputs))


def save(weights: Array, path: Path) -> None:
    """Write weights."""
    path.write_text(json.dumps([round(float(weight), 6) for weight in weights]) + "\n")


def load(path: Path) -> Array:
    """Read weights."""
    return np.array(json.loads(path.read_text()), dtype=np.float64)
