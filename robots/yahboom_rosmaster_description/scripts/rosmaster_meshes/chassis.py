"""The body: a tub between the wheels, two decks on posts, and the aerials behind."""

from arm_meshes.outline import rectangle
from arm_meshes.part import Part, Piece, box_between
from arm_meshes.solid import bevelled_box, cylinder, prism, union
from manifold3d import Manifold

LOWEST, HIGHEST = -54.0, 190.5
TUB_LOWER, TUB_UPPER = (-150.0, -54.0, LOWEST), (108.0, 54.0, 14.0)
"""The wheels' inner sides are 54.5 mm from the middle."""
DECK_LOWER, DECK_UPPER = (-176.0, -82.5), (116.5, 82.5)
DECK_FROM, DECK_TO = 14.0, 19.0
UPPER_DECK_LOWER, UPPER_DECK_UPPER = (-120.0, -62.0), (70.0, 62.0)
UPPER_DECK_FROM, UPPER_DECK_TO = 57.0, 61.5
"""The lidar's underside is at 61.6 mm."""
POSTS = tuple((x, y) for x in (-110.0, 60.0) for y in (-52.0, 52.0))
AERIALS = ((-165.0, -55.0), (-165.0, 55.0))
CAMERA_FOOT_LOWER, CAMERA_FOOT_UPPER = (76.0, -12.0, DECK_TO), (90.0, 12.0, 50.0)
"""It carries the camera, whose back is at 84 mm."""
MASS_KG = 4.6


def chassis() -> Part:
    """Return the link base_link; its frame is a wheel's radius above the axles."""
    tub = bevelled_box(TUB_LOWER, TUB_UPPER, bevel=8.0)
    decks = union(
        [
            prism(rectangle(DECK_LOWER, DECK_UPPER, corner=18.0), "z", DECK_FROM, DECK_TO),
            prism(
                rectangle(UPPER_DECK_LOWER, UPPER_DECK_UPPER, corner=12.0),
                "z",
                UPPER_DECK_FROM,
                UPPER_DECK_TO,
            ),
        ]
    )
    posts = union(cylinder("z", place, 4.0, DECK_TO, UPPER_DECK_FROM) for place in POSTS)
    posts += bevelled_box(CAMERA_FOOT_LOWER, CAMERA_FOOT_UPPER, bevel=1.5)
    pieces = (
        Piece("base_link", "green", tub),
        Piece("base_link_decks", "green", decks),
        Piece("base_link_posts", "steel", posts),
        Piece("base_link_aerials", "dark", _aerials()),
    )
    collision = box_between((-181.0, -69.3, 8.13), (119.0, 69.3, 205.38))
    return Part("base_link", pieces, (collision,), tub + decks + posts, mass_kg=MASS_KG)


def _aerials() -> Manifold:
    """Return two aerials, each a socket and a rod."""
    return union(
        solid
        for place in AERIALS
        for solid in (
            cylinder("z", place, 6.0, DECK_TO, 45.0),
            cylinder("z", place, 4.0, 45.0, HIGHEST),
        )
    )
