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


MOST_LAYERS = 30
"""A mask has 32 bits; the world has one, and a sign is none."""


@dataclass(frozen=True, slots=True)
class CollisionLayer:
    """Which robot of several a shape belongs to: it touches the world and the other robots."""

    index: int = 0
    count: int = 1

    def masks(self, self_collide: bool) -> CollisionMasks:
        """Return the masks of the robot's shapes; `self_collide` ones touch each other, too."""
        own = 2 << self.index
        others = sum(2 << index for index in range(self.count)) - own
        return CollisionMasks(own, WORLD_CONTYPE | others | (own if self_collide else 0))


def with_self(masks: CollisionMasks) -> CollisionMasks:
    """Return masks that touch shapes of the same robot besides."""
    return CollisionMasks(masks.contype, masks.conaffinity | masks.contype)


def leave_out_own_contacts(spec: mujoco.MjSpec, touching: Container[str]) -> None:
    """Exclude from contact all bodies of one thing with each other.

    Args:
        spec: has nothing but the thing, its bodies named; gets the exclusions.
        touching: names of bodies that touch all the others nevertheless.
    """
    solid = [
        (body.name, _carrier(body))
        for body in spec.bodies[1:]
        if any(geom.contype or geom.conaffinity for geom in body.geoms)
        and body.name not in touching
    ]
    for (first, carrier), (second, other_carrier) in combinations(solid, 2):
        # MuJoCo itself leaves out what is fixed to each other.
        if carrier != other_carrier:
            spec.add_exclude(bodyname1=first, bodyname2=second)


def _carrier(body: mujoco.MjsBody) -> str:
    """Return the name of the body with joints, or the world, that a body is fixed to."""
    while not body.joints and body.parent is not None:
        body = body.parent
    return str(body.name)


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
