"""The segments link3 and link4: two parallel housings, one for each joint, and a tube between."""

import math
from dataclasses import dataclass

from arm_meshes.part import CylinderCollision, Part, Piece
from arm_meshes.solid import cylinder, union
from manifold3d import Manifold

from mycobot_meshes.elbow import COLLAR, PROUD
from mycobot_meshes.housing import SEGMENTS, cap_disc, housing

FILLET = 6.0
SIDEWAYS = (0.0, -math.pi / 2, 0.0)


@dataclass(frozen=True, slots=True)
class Hub:
    """A housing around a joint, along z.

    Attributes:
        x: where the joint is.
        radius: of the housing.
        open_end: where it meets the neighbour.
        capped_end: where its cap is.
    """

    x: float
    radius: float
    open_end: float
    capped_end: float


def upper_arm() -> Part:
    """Return the link link3."""
    hubs = (Hub(0.0, 24.0, 29.9, 85.25), Hub(-110.4, 21.6, 29.9, 85.25))
    collision = CylinderCollision((-58.0, 0.0, 59.0), 25.0, 150.0, SIDEWAYS)
    return _segment("link3", hubs, 61.0, (21.0, 19.0), collision, 0.16)


def forearm() -> Part:
    """Return the link link4."""
    hubs = (Hub(0.0, 21.6, 35.4, -22.4), Hub(-96.0, 19.2, 35.4, -22.4))
    collision = CylinderCollision((-50.0, 0.0, 0.0), 25.0, 125.0, SIDEWAYS)
    return _segment("link4", hubs, -0.8, (19.0, 17.0), collision, 0.124)


def _segment(
    name: str,
    hubs: tuple[Hub, Hub],
    tube_z: float,
    tube_radii: tuple[float, float],
    collision: CylinderCollision,
    mass_kg: float,
) -> Part:
    ends = [
        cylinder("x", (0.0, tube_z), radius, hub.x - 1.0, hub.x + 1.0, SEGMENTS)
        for hub, radius in zip(hubs, tube_radii, strict=True)
    ]
    outside = Manifold.batch_hull(ends) + union(
        housing("z", (hub.x, 0.0), hub.radius, hub.open_end, hub.capped_end, FILLET) for hub in hubs
    )
    rooms, discs = zip(
        *(
            cap_disc("z", (h.x, 0.0), h.radius - FILLET + 1.0, h.capped_end, inside=h.open_end)
            for h in hubs
        ),
        strict=True,
    )
    collars = [_collar(hub) for hub in hubs]
    body = outside - union([*rooms, *collars])
    pieces = (Piece(name, "white", body), Piece(f"{name}_trim", "grey", union([*discs, *collars])))
    return Part(name, pieces, (collision,), outside, mass_kg)


def _collar(hub: Hub) -> Manifold:
    way = math.copysign(1.0, hub.capped_end - hub.open_end)
    start, end = sorted((hub.open_end - way * PROUD, hub.open_end + way * COLLAR))
    return cylinder("z", (hub.x, 0.0), hub.radius + PROUD, start, end, SEGMENTS)
