"""Angles of continuous joints, where a turn more or less is the same place."""

import numpy as np
from numpy.typing import NDArray

TURN = 2.0 * np.pi
SINGULARITY = 1e-9
"""Within this of half a turn, both ways round are equally short."""

Array = NDArray[np.float64]


def shortest_way(start: Array, end: Array) -> NDArray[np.float64]:
    """Return the way from one angle to another, in [-pi, pi].

    Half a turn goes the way that the numbers go: up where `end` is the greater.
    """
    difference = end - start
    way = np.remainder(difference + np.pi, TURN) - np.pi
    half_turn = np.abs(np.abs(way) - np.pi) < SINGULARITY
    return np.where(half_turn, np.copysign(np.abs(way), difference), way)


def nearest_turn(start: Array, end: Array, continuous: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return `start` moved by whole turns to within half a turn of `end`.

    Args:
        start: shape (n,).
        end: shape (n,).
        continuous: which joints turn without end, shape (n,); the others keep their `start`.
    """
    return np.where(continuous, end - shortest_way(start, end), start)
