"""Which shapes touch which: Gazebo's defaults in MuJoCo's terms."""

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport

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


def leave_out_neighbours(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    links: Sequence[str],
    report: BuildReport,
) -> None:
    """Exclude from contact the links that one joint connects, and those that overlap at first.

    Args:
        spec: gets the exclusions.
        model: compiled from it without them.
        qpos: starting positions, shape (nq,).
        links: names of the robot's bodies.
        report: says which links were found overlapping.
    """
    bodies = {model.body(name).id: name for name in links}
    jointed = set(_jointed_pairs(model, sorted(bodies)))
    overlapping = _overlapping_pairs(model, qpos, bodies) - jointed
    for first, second in sorted(jointed | overlapping):
        spec.add_exclude(bodyname1=bodies[first], bodyname2=bodies[second])
    for first, second in sorted(overlapping):
        report.warn(
            f"links '{bodies[first]}' and '{bodies[second]}'",
            "they overlap in the starting pose; they will not collide with each other",
        )


def _jointed_pairs(model: mujoco.MjModel, bodies: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies that one joint connects, through whatever is fixed to them.

    MuJoCo leaves out parent and child itself, but not where the parent is fixed to the world.
    """
    weld = model.body_weldid
    for first, second in combinations(bodies, 2):
        one, other = weld[first], weld[second]
        above, above_other = weld[model.body_parentid[one]], weld[model.body_parentid[other]]
        if one != other and (above == other or above_other == one):
            yield first, second


def _overlapping_pairs(
    model: mujoco.MjModel, qpos: NDArray[np.float64], bodies: Container[int]
) -> set[tuple[int, int]]:
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    pairs = set()
    for index in range(data.ncon):
        contact = data.contact[index]
        first, second = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if first in bodies and second in bodies and contact.dist < 0:
            pairs.add((first, second))
    return pairs
