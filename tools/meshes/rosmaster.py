"""The ROSMASTER X3: body, mecanum wheels and sensors, each part in the frame of its link.

The body is a tub between the wheels, two decks on posts, and the aerials behind. A wheel is a hub
between two discs and a ring of barrels at 45 degrees. Sizes are in mm; sizes, masses and contact
shapes are the robot's.
"""

from typing import Literal

from manifold3d import Manifold

from meshes.part import CylinderCollision, Part, Piece, box_between
from meshes.solid import bevelled_box, box, cylinder, prism, rectangle, union

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
BODY_KG = 4.6


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
    return Part("base_link", pieces, (collision,), tub + decks + posts, mass_kg=BODY_KG)


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


End = Literal["front", "back"]
Side = Literal["left", "right"]

ROLLERS = 10
RADIUS = 32.3
ROLLER_RADIUS, ROLLER_END_RADIUS = 6.4, 4.2
ROLLER_LENGTH = 30.0
ROLLER_SEGMENTS = 10
HALF_WIDTH = 15.2
INNER_END = 20.0
"""How far the hub reaches towards the robot."""
DISC_RADIUS = 24.0
WHEEL_KG = 9.1
LYING = (1.570796327, 0.0, 0.0)


def wheel(end: End, side: Side) -> Part:
    """Return the link of a wheel, which turns about its y axis.

    Seen from above, the barrels on top of the four wheels point to the robot's middle.
    """
    hand = 1.0 if (end == "front") == (side == "left") else -1.0
    name = f"{end}_{side}_wheel"
    rollers = union(_roller(number, hand) for number in range(ROLLERS))
    # The barrels bulge; together they are round.
    rollers ^= cylinder("y", (0.0, 0.0), RADIUS, -HALF_WIDTH, HALF_WIDTH, 60)
    hub = _hub(-1.0 if side == "left" else 1.0)
    body = cylinder("y", (0.0, 0.0), RADIUS, -HALF_WIDTH, HALF_WIDTH)
    return Part(
        f"{name}_link",
        (Piece(f"{name}_rollers", "dark", rollers), Piece(f"{name}_hub", "steel", hub)),
        (CylinderCollision((0.0, 0.0, 0.0), 32.5, 30.4, LYING),),
        body,
        mass_kg=WHEEL_KG,
    )


def _hub(inwards: float) -> Manifold:
    """Return the hub; `inwards` is the sign of y towards the robot."""
    ends = sorted((-inwards * HALF_WIDTH, inwards * INNER_END))
    axle = cylinder("y", (0.0, 0.0), 10.0, ends[0], ends[1])
    drum = cylinder("y", (0.0, 0.0), 18.0, -HALF_WIDTH + 2.0, HALF_WIDTH - 2.0)
    discs = [
        cylinder("y", (0.0, 0.0), DISC_RADIUS, y, y + 1.6)
        for y in (-HALF_WIDTH + 0.4, HALF_WIDTH - 2.0)
    ]
    return union([axle, drum, *discs])


def _roller(number: int, hand: float) -> Manifold:
    """Return one barrel, the first one on top of the wheel."""
    half = ROLLER_LENGTH / 2
    slices = [
        cylinder("x", (0.0, 0.0), radius, x, x + 0.5, ROLLER_SEGMENTS)
        for x, radius in (
            (-half, ROLLER_END_RADIUS),
            (-half / 2, ROLLER_RADIUS - 0.5),
            (-0.25, ROLLER_RADIUS),
            (half / 2 - 0.5, ROLLER_RADIUS - 0.5),
            (half - 0.5, ROLLER_END_RADIUS),
        )
    ]
    barrel = Manifold.batch_hull(slices).rotate((0.0, 0.0, hand * 45.0))
    on_top = barrel.translate((0.0, 0.0, RADIUS - ROLLER_RADIUS + 0.4))
    return on_top.rotate((0.0, number * 360.0 / ROLLERS, 0.0))


CAMERA_LOWER, CAMERA_UPPER = (-21.0, -45.0, -12.5), (3.2, 45.0, 12.5)
LENSES = {-30.0: 4.0, -8.0: 6.0, 15.0: 5.5, 35.0: 4.0}
"""Radius by y: projector, two infrared eyes and the one for colours."""
LIDAR_UNDERSIDE, LIDAR_TURRET_FROM, LIDAR_TOP = -20.85, -1.0, 18.0
IMU_HALF = (19.495, 18.925, 6.69)


def camera() -> Part:
    """Return the link cam_1_link, which looks along its x axis."""
    case = bevelled_box(CAMERA_LOWER, CAMERA_UPPER, bevel=5.0)
    face = CAMERA_UPPER[0]
    rooms = union(cylinder("x", (y, 0.0), r, face - 1.0, face + 1.0) for y, r in LENSES.items())
    lenses = union(cylinder("x", (y, 0.0), r, face - 1.2, face - 0.4) for y, r in LENSES.items())
    pieces = (Piece("cam_1", "grey", case - rooms), Piece("cam_1_lenses", "dark", lenses))
    return Part("cam_1_link", pieces, body=case, mass_kg=0.072)


def lidar() -> Part:
    """Return the link laser_frame: a turret on a square foot."""
    foot = prism(
        rectangle((-38.5, -38.2), (38.5, 38.2), corner=10.0),
        "z",
        LIDAR_UNDERSIDE,
        LIDAR_TURRET_FROM,
    )
    turret = cylinder("z", (0.0, 0.0), 37.0, LIDAR_TURRET_FROM, LIDAR_TOP, 48)
    window = cylinder("z", (0.0, 0.0), 38.0, 3.0, 13.0, 48)
    pieces = (
        Piece("laser_frame", "black", foot + (turret - window)),
        Piece("laser_frame_window", "dark", window ^ cylinder("z", (0, 0), 36.6, 2.8, 13.2, 48)),
    )
    return Part("laser_frame", pieces, body=foot + turret, mass_kg=0.185)


def imu() -> Part:
    """Return the link imu_link: a board with a chip, as large as the original's box."""
    x, y, z = IMU_HALF
    board = box((-x, -y, -z), (x, y, -z + 2.0))
    chip = bevelled_box((-12.0, -12.0, -z + 2.0), (12.0, 12.0, z), bevel=1.0)
    return Part(
        "imu_link", (Piece("imu_link", "black", board + chip),), body=board + chip, mass_kg=0.031
    )
