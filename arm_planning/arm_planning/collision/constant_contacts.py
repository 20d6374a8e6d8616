"""Contacts that are there in every state: between bodies that never move against each other.

MuJoCo does not look for them, because it takes such bodies for welded together: the robot's base
and the objects of the world, or a gripper and what is attached to it.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class GeomContact:
    """Two geoms in each other.

    Attributes:
        first: MuJoCo's id of a geom.
        second: that of the other.
        distance: in m, negative.
        position: between their surfaces, (3,).
        normal: unit vector from the first to the second, (3,).
    """

    first: int
    second: int
    distance: float
    position: Array
    normal: Array


def constant_contacts(
    model: mujoco.MjModel, data: mujoco.MjData, asked: NDArray[np.bool_]
) -> Iterator[GeomContact]:
    """Yield the contacts between bodies that are welded together.

    Args:
        model: the model; its masks and excluded pairs count.
        data: its state, with the geoms' poses.
        asked: which bodies matter, (nbody,); one of a pair must.
    """
    for first, second in _candidates(model, data, asked):
        line = np.zeros(6)
        distance = mujoco.mj_geomDistance(model, data, first, second, 0.0, line)
        if distance < 0.0:
            # It leads from the surface of the first, inside of the second, back to the second's.
            normal = (line[:3] - line[3:]) / -distance
            yield GeomContact(first, second, distance, (line[:3] + line[3:]) / 2, normal)


def _candidates(
    model: mujoco.MjModel, data: mujoco.MjData, asked: NDArray[np.bool_]
) -> list[tuple[int, int]]:
    """Return pairs of geoms on bodies welded together whose bounding spheres overlap."""
    body, weld = model.geom_bodyid, model.body_weldid[model.geom_bodyid]
    firsts, every = np.flatnonzero(asked[body]), np.arange(model.ngeom)
    mine = body[firsts, None]
    may = (weld[firsts, None] == weld) & (mine != body)
    # Both are asked for: the pair comes once.
    may &= ~asked[body] | (every > firsts[:, None])
    may &= (model.geom_contype[firsts, None] & model.geom_conaffinity != 0) | (
        model.geom_conaffinity[firsts, None] & model.geom_contype != 0
    )
    rows, seconds = np.nonzero(may)
    firsts = firsts[rows]
    low, high = np.sort([body[firsts], body[seconds]], axis=0)
    near = ~np.isin((low << 16) + high, model.exclude_signature)
    # A plane has no radius: it is endless.
    radius = np.where(model.geom_rbound > 0.0, model.geom_rbound, np.inf)
    apart = np.linalg.norm(data.geom_xpos[firsts] - data.geom_xpos[seconds], axis=1)
    near &= apart < radius[firsts] + radius[seconds]
    return list(zip(firsts[near].tolist(), seconds[near].tolist(), strict=True))
