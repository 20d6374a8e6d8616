"""Motions: what joints do at one moment, as one array.

A motion has shape (4, n): for each of n joints its position [rad or m], velocity, acceleration
and effort [N m or N]. NaN stands for what is not known or not asked for.
"""

import numpy as np
from numpy.typing import NDArray

POSITION, VELOCITY, ACCELERATION, EFFORT = range(4)
ROWS = 4

QUANTITIES = ("position", "velocity", "acceleration", "effort")
"""The rows by the names of their interfaces."""

RESOLUTION_S = 1e-9
"""Times nearer to each other than this are the same: ROS has nothing finer."""

LARGEST = 1e15
"""No number of a client may be greater: a float64 does not even tell one radian from the next
there, and polynomials through such numbers could overflow."""


def at_rest(position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the motion of joints that stand at `position`, shape (n,), and exert nothing."""
    motion = np.zeros((ROWS, len(position)))
    motion[POSITION] = position
    return motion
