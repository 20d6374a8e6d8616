"""The servo: an AX-12-like case, 50 x 32 x 36 mm, whose horn turns about z near one end."""

from manifold3d import Manifold

from arm_meshes.outline import rectangle
from arm_meshes.part import CylinderCollision, Part, Piece, box_between
from arm_meshes.solid import bevelled_box, box, cylinder, prism, union

CASE_LOWER = (-11.5, -16.0, -18.0)
CASE_UPPER = (38.5, 16.0, 17.0)
HORN_TOP = 21.0
HORN_RADIUS = 11.0
IDLER_BOTTOM = -19.0
IDLER_RADIUS = 8.0
SEAM = -2.0
"""Height of the groove between the halves of the case."""

SOCKET_XS = (20.0, 31.0)
SOCKET_SIZE = (7.0, 5.0)


def servo() -> Part:
    """Return the links dyn2 to dyn5: the case and its cable sockets."""
    case = _case()
    sockets = union(_socket(x) for x in SOCKET_XS)
    pieces = (Piece("dyn", "dark", case), Piece("dyn_socket", "light", sockets))
    middle = (CASE_UPPER[2] + HORN_TOP) / 2
    collisions = (
        box_between((*CASE_LOWER[:2], IDLER_BOTTOM), CASE_UPPER),
        CylinderCollision((0.0, 0.0, middle), HORN_RADIUS, HORN_TOP - CASE_UPPER[2]),
    )
    return Part("dyn", pieces, collisions, body=case + sockets + _horn() + _idler())


def horn() -> Part:
    """Return what a servo turns, for the links dyn2_r to dyn5_r: its mass is the servo's."""
    return Part("dyn_horn", (Piece("dyn_horn", "steel", _horn() + _idler()),))


def _case() -> Manifold:
    case = bevelled_box(CASE_LOWER, CASE_UPPER, bevel=1.6)
    cuts = [_seam(), *_side_grooves(), *_corner_screws(), *(_socket_room(x) for x in SOCKET_XS)]
    return case - union(cuts)


def _seam() -> Manifold:
    """Return a shallow groove all around."""
    outside = rectangle((-20, -20), (50, 20))
    inside = rectangle(
        (CASE_LOWER[0] + 0.6, CASE_LOWER[1] + 0.6), (CASE_UPPER[0] - 0.6, CASE_UPPER[1] - 0.6)
    )
    return prism(outside - inside, "z", SEAM - 0.5, SEAM + 0.5)


def _side_grooves() -> list[Manifold]:
    """Return the cooling grooves of both sides and the sunk field for a label beside them."""
    cuts = []
    for side in (CASE_LOWER[1], CASE_UPPER[1]):
        for x in (-6.0, -2.0, 2.0, 6.0):
            cuts.append(box((x - 0.9, side - 1.0, 1.5), (x + 0.9, side + 1.0, 12.0)))
        cuts.append(box((14.0, side - 0.6, -14.0), (32.0, side + 0.6, -5.0)))
    return cuts


def _corner_screws() -> list[Manifold]:
    """Return the holes that hold the case together, from both ends."""
    return [
        cylinder("z", (x, y), 1.6, start, start + 3.0, segments=12)
        for x in (-7.5, 34.5)
        for y in (-12.0, 12.0)
        for start in (CASE_LOWER[2] - 1.0, CASE_UPPER[2] - 2.0)
    ]


def _socket_room(x: float) -> Manifold:
    dx, dy = SOCKET_SIZE[0] / 2, SOCKET_SIZE[1] / 2
    return box((x - dx, -dy, CASE_LOWER[2] - 1.0), (x + dx, dy, CASE_LOWER[2] + 4.0))


def _socket(x: float) -> Manifold:
    """Return a socket: a sunk frame with three pins."""
    dx, dy = SOCKET_SIZE[0] / 2, SOCKET_SIZE[1] / 2
    bottom = CASE_LOWER[2]
    frame = rectangle((x - dx, -dy), (x + dx, dy)) - rectangle(
        (x - dx + 0.9, -dy + 0.9), (x + dx - 0.9, dy - 0.9)
    )
    floor = box((x - dx, -dy, bottom + 3.0), (x + dx, dy, bottom + 4.0))
    pins = [box((x + i - 0.3, -0.3, bottom + 0.8), (x + i + 0.3, 0.3, bottom + 4.0)) for i in (-1.7, 0, 1.7)]
    return union([prism(frame, "z", bottom - 0.2, bottom + 4.0), floor, *pins])


def _horn() -> Manifold:
    top = HORN_TOP - 0.6
    disc = cylinder("z", (0, 0), HORN_RADIUS, CASE_UPPER[2], CASE_UPPER[2] + 2.0, segments=48)
    hub = cylinder("z", (0, 0), HORN_RADIUS - 1.5, CASE_UPPER[2], top, segments=48)
    screws = [
        cylinder("z", centre, 1.4, top - 1, HORN_TOP, segments=12)
        for centre in ((6.5, 0), (0, 6.5), (-6.5, 0), (0, -6.5))
    ]
    middle = cylinder("z", (0, 0), 3.0, top - 1, HORN_TOP, segments=6)
    return union([disc, hub, middle, *screws])


def _idler() -> Manifold:
    return cylinder("z", (0, 0), IDLER_RADIUS, IDLER_BOTTOM, CASE_LOWER[2], segments=32)
