"""Which shapes collide: Gazebo's defaults expressed in MuJoCo's terms."""

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport

WORLD_CONTYPE = 1
"""MuJoCo's default for a geom, so that every world file works unchanged."""


@dataclass(frozen=True, slots=True)
class CollisionMasks:
    """MuJoCo's two bit masks: two shapes collide if the type of one is in the other's affinity."""

    contype: int
    conaffinity: int


MAX_LAYERS = 30
"""A mask has 32 bits. The world uses one, and the sign bit is not usable."""


@dataclass(frozen=True, slots=True)
class CollisionLayer:
    """The robot that a shape belongs to, by index; it collides with the world and other robots."""

    index: int = 0
    count: int = 1

    def masks(self, self_collide: bool) -> CollisionMasks:
        """Return the masks of the robot's shapes; with `self_collide` they touch each other too."""
        own = 2 << self.index
        others = sum(2 << index for index in range(self.count)) - own
        return CollisionMasks(own, WORLD_CONTYPE | others | (own if self_collide else 0))


def with_self(masks: CollisionMasks) -> CollisionMasks:
    """Return masks that also collide with shapes of the same robot."""
    return CollisionMasks(masks.contype, masks.conaffinity | masks.contype)


def exclude_own_contacts(spec: mujoco.MjSpec, touching: Container[str]) -> None:
    """Exclude contacts between the bodies of one entity.

    Args:
        spec: contains only the entity, with named bodies; receives the exclusions.
        touching: names of bodies that still collide with all the others.
    """
    solid = [
        (body.name, _carrier(body))
        for body in spec.bodies[1:]
        if any(geom.contype or geom.conaffinity for geom in body.geoms)
        and body.name not in touching
    ]
    for (first, carrier), (second, other_carrier) in combinations(solid, 2):
        # MuJoCo itself excludes bodies that are fixed to each other.
        if carrier != other_carrier:
            spec.add_exclude(bodyname1=first, bodyname2=second)


def _carrier(body: mujoco.MjsBody) -> str:
    """Return the name of the moving body, or the world, that a body is fixed to."""
    while not body.joints and body.parent is not None:
        body = body.parent
    return str(body.name)


def exclude_neighbour_contacts(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    links: Sequence[str],
    report: BuildReport,
) -> None:
    """Exclude contacts between links that a joint connects, and links that overlap at the start.

    Args:
        spec: receives the exclusions.
        model: compiled from `spec` without the exclusions.
        qpos: starting positions, shape (nq,).
        links: names of the robot's bodies.
        report: receives a warning for each overlapping pair.
    """
    bodies = {model.body(name).id: name for name in links}
    jointed = set(jointed_pairs(model, sorted(bodies)))
    depths = _overlapping_pairs(model, qpos, bodies)
    overlapping = depths.keys() - jointed
    for first, second in sorted(jointed | overlapping):
        spec.add_exclude(bodyname1=bodies[first], bodyname2=bodies[second])
    for first, second in sorted(overlapping):
        report.warn(
            f"links '{bodies[first]}' and '{bodies[second]}'",
            f"they overlap by {depths[first, second] * 1000:.3g} mm in the starting pose; they "
            "will not collide with each other",
        )


def jointed_pairs(model: mujoco.MjModel, bodies: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies that one joint connects, including bodies fixed to either side.

    MuJoCo itself excludes parent and child, but not if the parent is fixed to the world.
    """
    weld = model.body_weldid
    for first, second in combinations(bodies, 2):
        one, other = weld[first], weld[second]
        above, above_other = weld[model.body_parentid[one]], weld[model.body_parentid[other]]
        if one != other and (above == other or above_other == one):
            yield first, second


def _overlapping_pairs(
    model: mujoco.MjModel, qpos: NDArray[np.float64], bodies: Container[int]
) -> dict[tuple[int, int], float]:
    """Return the bodies that overlap, and how deep in m."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    depths: dict[tuple[int, int], float] = {}
    for index in range(data.ncon):
        contact = data.contact[index]
        first, second = sorted(int(model.geom_bodyid[geom]) for geom in contact.geom)
        if first in bodies and second in bodies and contact.dist < 0:
            depths[first, second] = max(depths.get((first, second), 0.0), -float(contact.dist))
    return depths
