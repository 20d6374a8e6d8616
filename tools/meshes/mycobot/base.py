"""The static parts: the base plate, and the pedestal with its screen."""

from manifold3d import Manifold

from meshes.mycobot.arm import SEGMENTS, housing
from meshes.part import Part, Piece, box_between
from meshes.solid import (
    bevelled_box,
    bevelled_prism,
    box,
    circle,
    cylinder,
    prism,
    rectangle,
    union,
)

PLATE_HALF = (52.5, 70.0)
UNDERSIDE, PLATE_TOP = -25.0, -5.0
"""The arm stands on the floor when base_link is 25 mm above it."""
SCREW_HOLES = ((-42.5, -60.0), (42.5, -60.0), (-42.5, 60.0), (42.5, 60.0))
RING_RADIUS = 46.5

PEDESTAL_RADIUS = 45.0
PEDESTAL_TOP = 73.0
NECK_RADIUS = 30.0
NECK_TOP = 68.5
"""Link2 turns in here: its lower end reaches down to 67.4 mm."""
PANEL_LOWER = (-32.0, -52.0, 8.0)
PANEL_UPPER = (32.0, -20.0, 64.0)
SCREEN_LOWER, SCREEN_UPPER = (-22.0, 24.0), (22.0, 58.0)
"""The screen in (x, z)."""
BUTTON_XS = (-14.0, 0.0, 14.0)


def base_plate() -> Part:
    """Return the link base_link: a plate with rounded corners and a ring for the pedestal."""
    x, y = PLATE_HALF
    outline = rectangle((-x, -y), (x, y), corner=14.0)
    plate = bevelled_prism(outline, "z", UNDERSIDE, PLATE_TOP, bevel=2.5)
    holes = [
        cylinder("z", centre, radius, start, PLATE_TOP + 1.0)
        for centre in SCREW_HOLES
        for radius, start in ((3.2, UNDERSIDE - 1.0), (5.5, PLATE_TOP - 5.0))
    ]
    body = plate - union(holes)
    ring = cylinder("z", (0.0, 0.0), RING_RADIUS, PLATE_TOP - 1.0, 0.0, SEGMENTS)
    pieces = (Piece("base_link", "grey", body), Piece("base_link_ring", "dark", ring))
    collision = box_between((-x, -y, UNDERSIDE), (x, y, PLATE_TOP))
    return Part("base_link", pieces, (collision,), body + ring, mass_kg=0.33)


def pedestal() -> Part:
    """Return the link link1: a round box with a screen and three buttons at its front."""
    turned = housing("z", (0.0, 0.0), PEDESTAL_RADIUS, 0.0, PEDESTAL_TOP, fillet=9.0)
    well = cylinder("z", (0.0, 0.0), NECK_RADIUS, NECK_TOP, PEDESTAL_TOP + 1.0, SEGMENTS)
    groove = prism(circle((0.0, 0.0), 50.0) - circle((0.0, 0.0), 44.2, SEGMENTS), "z", 5.0, 6.2)
    front = bevelled_box(PANEL_LOWER, PANEL_UPPER, bevel=2.0)
    body = turned - well - groove - front
    panel = front - _screen(room=True) - union(_buttons(room=True))
    pieces = (
        Piece("link1", "grey", body),
        Piece("link1_panel", "dark", panel),
        Piece("link1_screen", "screen", _screen(room=False)),
        Piece("link1_buttons", "white", union(_buttons(room=False))),
    )
    collision = box_between((-40.0, -70.0, -3.5), (40.0, 50.0, 71.5))
    return Part("link1", pieces, (collision,), turned - well + front, mass_kg=0.12)


def _screen(room: bool) -> Manifold:
    """Return the screen, or the room that it lies in."""
    (x0, z0), (x1, z1) = SCREEN_LOWER, SCREEN_UPPER
    gap, face = (0.0, PANEL_LOWER[1] - 1.0) if room else (0.2, PANEL_LOWER[1] + 0.8)
    return box((x0 + gap, face, z0 + gap), (x1 - gap, PANEL_LOWER[1] + 3.0 + gap, z1 - gap))


def _buttons(room: bool) -> list[Manifold]:
    """Return the buttons below the screen, or the rooms that they move in."""
    gap, face = (0.0, PANEL_LOWER[1] - 1.0) if room else (0.3, PANEL_LOWER[1] + 0.2)
    y = PANEL_LOWER[1] + 3.0 + gap
    return [box((x - 5 + gap, face, 12 + gap), (x + 5 - gap, y, 18 - gap)) for x in BUTTON_XS]
