"""A copy of where everything in a simulation is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class WorldState:
    """One state of one model.

    Attributes:
        time_s: simulation time.
        qpos: generalised positions, shape (nq,).
        qvel: generalised velocities, shape (nv,).
        mocap_pos: positions of the mocap bodies, shape (nmocap, 3).
        mocap_quat: their quaternions (w, x, y, z), shape (nmocap, 4).
    """

    time_s: float
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]
    mocap_pos: NDArray[np.float64]
    mocap_quat: NDArray[np.float64]
