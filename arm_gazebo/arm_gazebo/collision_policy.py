"""Which shapes touch which: Gazebo's defaults in MuJoCo's terms."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import mujoco

WORLD_CONTYPE = 1
"""MuJoCo's default for a geom: so any world file works, whatever it says."""


@dataclass(frozen=True, slots=True)
class CollisionMasks:
    """MuJoCo's two bit masks: shapes touch where one's type is in the other's affinity."""

    contype: int
    conaffinity: int


WORLD_ONLY = CollisionMasks(contype=2, conaffinity=WORLD_CONTYPE)
"""Touches the world, and not what has the same masks."""
SELF_TOO = CollisionMasks(contype=2, conaffinity=WORLD_CONTYPE | 2)
"""Touches the world and what has the same masks."""


def masks_for(self_collide: bool) -> CollisionMasks:
    """Return the masks of a robot's collisions."""
    return SELF_TOO if self_collide else WORLD_ONLY


def jointed_pairs(model: mujoco.MjModel, bodies: frozenset[int]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies that one joint connects, through whatever is fixed to them.

    MuJoCo leaves out parent and child itself, but not where the parent is fixed to the world.
    """
    parent_of_weld = {
        model.body_weldid[body]: model.body_weldid[model.body_parentid[model.body_weldid[body]]]
        for body in bodies
    }
    for first, second in combinations(sorted(bodies), 2):
        weld, other = model.body_weldid[first], model.body_weldid[second]
        if weld != other and (parent_of_weld[weld] == other or parent_of_weld[other] == weld):
            yield first, second


def overlapping_pairs(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: frozenset[int]
) -> set[tuple[int, int]]:
    """Return the pairs of these bodies that are in contact in the state of `data`."""
    mujoco.mj_fwdPosition(model, data)
    pairs = set()
    for contact in data.contact[: data.ncon]:
        first, second = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if first in bodies and second in bodies and contact.dist < 0:
            pairs.add((first, second))
    return pairs
