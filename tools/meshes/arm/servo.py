"""The servo: an AX-12-like case, 50 x 32 x 36 mm, whose horn turns about z near one end."""

from manifold3d import CrossSection, Manifold

from meshes.part import Part, Piece, box_between
from meshes.solid import Point, box, cylinder, polygon, prism, rectangle, union

CASE_LOWER = (-11.5, -16.0, -18.0)
CASE_UPPER = (38.5, 16.0, 17.0)
HORN_TOP = 21.0
HORN_RADIUS = 11.0
IDLER_BOTTOM = -19.0
IDLER_RADIUS = 8.0
SEAM = -2.0
"""Height of the groove between the halves of the case."""
BEVEL = 1.6
NOSE_BEVEL = 4.5
"""At the end where the horn is, so that brackets pass it closely."""

SOCKET_XS = (20.0, 31.0)
SOCKET_HALF_SIZE = (3.5, 2.5)
LABEL_LOWER, LABEL_UPPER = (14.0, -13.0), (32.0, -6.0)
"""The label of both sides, in (x, z)."""
LABEL_SUNK = 0.4


def servo() -> Part:
    """Return the links dyn2 to dyn5: the case, its labels and cable sockets."""
    case = _case()
    trim = union([*(_socket(x) for x in SOCKET_XS), *_labels(sunk=LABEL_SUNK)])
    pieces = (Piece("dyn", "servo", case), Piece("dyn_trim", "light", trim))
    # The horn has no collision shape, because the part that is screwed to it always covers it.
    collisions = (box_between((*CASE_LOWER[:2], IDLER_BOTTOM), CASE_UPPER),)
    return Part("dyn", pieces, collisions, body=case + trim + _horn() + _idler())


def horn() -> Part:
    """Return a servo's horn, for the links dyn2_r to dyn5_r; it has the servo's mass."""
    return Part("dyn_horn", (Piece("dyn_horn", "steel", _horn() + _idler()),))


def _case() -> Manifold:
    x0, _, z0 = CASE_LOWER
    x1, y1, z1 = CASE_UPPER
    nose, tail = NOSE_BEVEL, BEVEL
    left: list[Point] = [(x1, y1 - tail), (x1 - tail, y1), (x0 + nose, y1), (x0, y1 - nose)]
    outline = polygon([*left, *((x, -y) for x, y in reversed(left))])
    lid = prism(outline.offset(-BEVEL), "z", z0, z1)
    block = Manifold.batch_hull([prism(outline, "z", z0 + BEVEL, z1 - BEVEL), lid])
    rooms = [_socket_room(x) for x in SOCKET_XS]
    cuts = [_seam(), *_cooling_grooves(), *_labels(sunk=0.0), *_corner_screws(), *rooms]
    return block - union(cuts)


def _seam() -> Manifold:
    """Return a shallow groove all around."""
    outside = rectangle((-20, -20), (50, 20))
    inside = rectangle(
        (CASE_LOWER[0] + 0.6, CASE_LOWER[1] + 0.6), (CASE_UPPER[0] - 0.6, CASE_UPPER[1] - 0.6)
    )
    return prism(outside - inside, "z", SEAM - 0.5, SEAM + 0.5)


def _cooling_grooves() -> list[Manifold]:
    return [
        box((x - 0.9, side - 1.0, 1.5), (x + 0.9, side + 1.0, 12.0))
        for side in (CASE_LOWER[1], CASE_UPPER[1])
        for x in (-3.0, 1.0, 5.0, 9.0)
    ]


def _labels(sunk: float) -> list[Manifold]:
    """Return both labels, or with `sunk` 0 the fields that they are sunk into."""
    (x0, z0), (x1, z1) = LABEL_LOWER, LABEL_UPPER
    depth, top = 1.0, CASE_UPPER[1] - sunk
    return [
        box((x0, -top, z0), (x1, depth - CASE_UPPER[1], z1)),
        box((x0, CASE_UPPER[1] - depth, z0), (x1, top, z1)),
    ]


def _corner_screws() -> list[Manifold]:
    """Return the holes that hold the case together, from both ends."""
    return [
        cylinder("z", (x, y), 1.6, start, start + 3.0, segments=12)
        for x in (-7.5, 34.5)
        for y in (-12.0, 12.0)
        for start in (CASE_LOWER[2] - 1.0, CASE_UPPER[2] - 2.0)
    ]


def _socket_outline(x: float, wall: float = 0.0) -> CrossSection:
    dx, dy = SOCKET_HALF_SIZE[0] - wall, SOCKET_HALF_SIZE[1] - wall
    return rectangle((x - dx, -dy), (x + dx, dy))


def _socket_room(x: float) -> Manifold:
    return prism(_socket_outline(x), "z", CASE_LOWER[2] - 1.0, CASE_LOWER[2] + 4.0)


def _socket(x: float) -> Manifold:
    """Return a frame with three pins in it."""
    bottom = CASE_LOWER[2]
    cup = prism(_socket_outline(x), "z", bottom - 0.2, bottom + 4.0)
    hollow = prism(_socket_outline(x, wall=0.9), "z", bottom - 1.0, bottom + 3.0)
    pins = [
        box((x + dx - 0.3, -0.3, bottom + 0.8), (x + dx + 0.3, 0.3, bottom + 4.0))
        for dx in (-1.7, 0.0, 1.7)
    ]
    return cup - hollow + union(pins)


def _horn() -> Manifold:
    top = HORN_TOP - 0.6
    disc = cylinder("z", (0, 0), HORN_RADIUS, CASE_UPPER[2], CASE_UPPER[2] + 2.0, segments=36)
    hub = cylinder("z", (0, 0), HORN_RADIUS - 1.5, CASE_UPPER[2], top, segments=36)
    screws = [
        cylinder("z", centre, 1.4, top - 1, HORN_TOP, segments=12)
        for centre in ((6.5, 0), (0, 6.5), (-6.5, 0), (0, -6.5))
    ]
    middle = cylinder("z", (0, 0), 3.0, top - 1, HORN_TOP, segments=6)
    return union([disc, hub, middle, *screws])


def _idler() -> Manifold:
    return cylinder("z", (0, 0), IDLER_RADIUS, IDLER_BOTTOM, CASE_LOWER[2])
