"""Quaternions in MuJoCo's order."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import quaternion_from_rpy


def wxyz(rpy: Sequence[float]) -> NDArray[np.float64]:
    """Return MuJoCo's quaternion (w, x, y, z) of a URDF's roll, pitch, yaw."""
    return np.roll(quaternion_from_rpy(rpy), 1)
