"""The myCobot's links: round housings for the joints, and tubes between them."""

import math
from dataclasses import dataclass

from manifold3d import Manifold

from meshes.part import BoxCollision, CylinderCollision, Part, Piece
from meshes.solid import Axis, Point, cylinder, union

SEGMENTS = 48
FILLET_STEPS = 5
SUNK = 0.6
"""How far the disc of a cap lies below the cap's face."""
MARGIN = 4.0
"""Between the disc of a cap and the housing's side."""


def housing(
    axis: Axis, centre: Point, radius: float, open_end: float, capped_end: float, fillet: float
) -> Manifold:
    """Return a cylinder whose capped end has a rounded edge; either end may be the upper one."""
    way = math.copysign(1.0, capped_end - open_end)
    slices = [_slice(axis, centre, radius, open_end, capped_end - way * fillet)]
    for step in range(1, FILLET_STEPS + 1):
        angle = math.pi / 2 * step / FILLET_STEPS
        face = capped_end - way * fillet * (1 - math.sin(angle))
        inset = fillet * (1 - math.cos(angle))
        slices.append(_slice(axis, centre, radius - inset, open_end, face))
    return Manifold.batch_hull(slices)


def cap_disc(
    axis: Axis, centre: Point, radius: float, capped_end: float, inside: float
) -> tuple[Manifold, Manifold]:
    """Return the recess for a disc in a housing's face, and the disc in it.

    Args:
        axis: the housing's.
        centre: in the two axes that `prism` names.
        radius: of the housing.
        capped_end: where its face is.
        inside: any place on the axis that is inside the housing.
    """
    way = math.copysign(1.0, capped_end - inside)
    room = _slice(axis, centre, radius - MARGIN, capped_end - way * 3.0, capped_end + way)
    disc = _slice(
        axis, centre, radius - MARGIN - 0.15, capped_end - way * 3.2, capped_end - way * SUNK
    )
    return room, disc


def _slice(axis: Axis, centre: Point, radius: float, start: float, end: float) -> Manifold:
    return cylinder(axis, centre, radius, min(start, end), max(start, end), SEGMENTS)


COLLAR = 3.0
"""Length of the ring where a housing meets its neighbour."""
PROUD = 0.02
"""A collar's faces stand out by this, so that no film of the housing is left over it."""


def shoulder() -> Part:
    """Return the link link2."""
    collision = CylinderCollision((0.0, 0.0, -20.0), 25.0, 85.0)
    return _elbow("link2", 24.0, (-64.1, 22.9), 22.9, -36.5, collision, 0.19)


def forearm_elbow() -> Part:
    """Return the link link5."""
    collision = BoxCollision((0.0, 0.0, -5.0), (30.0, 35.0, 50.0))
    return _elbow("link5", 19.25, (-33.7, 19.0), 18.6, -36.6, collision, 0.11)


def _elbow(
    name: str,
    radius: float,
    upright: tuple[float, float],
    branch_radius: float,
    branch_end: float,
    collision: BoxCollision | CylinderCollision,
    mass_kg: float,
) -> Part:
    """Return an elbow: upright along z with its cap above, the branch along -y."""
    foot, top = upright
    centre_z = top - radius if top < radius else 0.0
    outside = union(
        [
            housing("z", (0.0, 0.0), radius, foot, top, fillet=5.0),
            cylinder("y", (centre_z, 0.0), branch_radius, branch_end, 0.0, SEGMENTS),
        ]
    )
    standing, lying = (foot - PROUD, foot + COLLAR), (branch_end - PROUD, branch_end + COLLAR)
    collars = union(
        [
            cylinder("z", (0.0, 0.0), radius + PROUD, *standing, SEGMENTS),
            cylinder("y", (centre_z, 0.0), branch_radius + PROUD, *lying, SEGMENTS),
        ]
    )
    room, disc = cap_disc("z", (0.0, 0.0), radius - 4.0, top, inside=foot)
    body = outside - room - collars
    pieces = (Piece(name, "white", body), Piece(f"{name}_trim", "grey", collars + disc))
    return Part(name, pieces, (collision,), outside, mass_kg)


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


RADIUS = 19.2
FRONT, BACK = 35.1, -21.6
"""Of the lying housing, along y: the flange is at the front."""
STEM_END = -38.0
STEM_RADIUS = 18.7
FLANGE_BACK, FLANGE_FACE = -12.0, 1.7
SCREW_CIRCLE = 14.5


def wrist() -> Part:
    """Return the link link6."""
    outside = union(
        [
            housing("y", (0.0, 0.0), RADIUS, FRONT, BACK, fillet=5.0),
            cylinder("z", (0.0, 0.0), STEM_RADIUS, STEM_END, 0.0, SEGMENTS),
        ]
    )
    room, disc = cap_disc("y", (0.0, 0.0), RADIUS - 4.0, BACK, inside=FRONT)
    standing, lying = (STEM_END - PROUD, STEM_END + COLLAR), (FRONT - COLLAR, FRONT + PROUD)
    collars = union(
        [
            cylinder("z", (0.0, 0.0), STEM_RADIUS + PROUD, *standing, SEGMENTS),
            cylinder("y", (0.0, 0.0), RADIUS + PROUD, *lying, SEGMENTS),
        ]
    )
    pieces = (
        Piece("link6", "white", outside - room - collars),
        Piece("link6_trim", "grey", collars + disc),
    )
    collision = CylinderCollision((0.0, 0.0, 0.0), 25.0, 60.0, (-math.pi / 2, 0.0, 0.0))
    return Part("link6", pieces, (collision,), outside, mass_kg=0.0739)


def flange() -> Part:
    """Return the link link6_flange."""
    disc = cylinder("z", (0.0, 0.0), RADIUS, FLANGE_BACK, FLANGE_FACE, SEGMENTS)
    holes = [cylinder("z", (0.0, 0.0), 6.0, FLANGE_FACE - 4.0, FLANGE_FACE + 1.0)]
    for quarter in range(4):
        angle = math.pi / 4 + quarter * math.pi / 2
        centre = (SCREW_CIRCLE * math.cos(angle), SCREW_CIRCLE * math.sin(angle))
        holes.append(cylinder("z", centre, 1.6, FLANGE_FACE - 6.0, FLANGE_FACE + 1.0, 12))
    body = disc - union(holes)
    collision = CylinderCollision((0.0, 0.0, 0.0), 20.0, 20.0)
    pieces = (Piece("link6_flange", "grey", body),)
    return Part("link6_flange", pieces, (collision,), body, mass_kg=0.035)
