"""Angles of continuous joints, where a full turn makes no difference."""

import numpy as np
from numpy.typing import NDArray

TURN = 2.0 * np.pi
SINGULARITY = 1e-9
"""Within this of half a turn, both directions count as equally short."""

Array = NDArray[np.float64]


def shortest_angular_distance(start: Array, end: Array) -> NDArray[np.float64]:
    """Return the shortest rotation from one angle to another, in [-pi, pi].

    Half a turn goes in the direction of the numbers: up if `end` is greater.
    """
    difference = end - start
    distance = np.remainder(difference + np.pi, TURN) - np.pi
    half_turn = np.abs(np.abs(distance) - np.pi) < SINGULARITY
    return np.where(half_turn, np.copysign(np.abs(distance), difference), distance)


def nearest_turn(start: Array, end: Array, continuous: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return `start` moved by whole turns to within half a turn of `end`.

    Args:
        start: shape (n,).
        end: shape (n,).
        continuous: which joints are continuous, shape (n,); the others keep their `start`.
    """
    return np.where(continuous, end - shortest_angular_distance(start, end), start)
