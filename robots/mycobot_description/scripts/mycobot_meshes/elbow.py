"""The elbows link2 and link5: a housing around the joint below, a branch for the one beside."""

from arm_meshes.part import BoxCollision, CylinderCollision, Part, Piece
from arm_meshes.solid import cylinder, union

from mycobot_meshes.housing import SEGMENTS, cap_disc, housing

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
