"""Chooses the first view of a scene: a camera position from which its robots are visible.

The page in the browser and the window both use it.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

NEAR_FACTOR = 1.2
"""Things no larger than the robots and within this many robot sizes of them are near."""
MAX_SPREAD = 1.5
"""How many times as large as the robots the subject of a picture may be."""
MARGIN = 1.15
"""Factor by which the picture is larger than its subject."""
MIN_SIZE_M = 0.1
AZIMUTHS = tuple(math.radians(a) for a in (-45, -15, -75, 45, -135, 90, 135, 180))
"""Camera azimuths around the middle, from the x axis, in order of preference."""
ELEVATIONS = tuple(math.radians(e) for e in (22, 42, 65))
STEEPER_COST, TURNED_COST = 0.06, 0.01
"""Cost of a step in ELEVATIONS and in AZIMUTHS, as a fraction of the visible points."""
MAX_SAMPLES = 10
ABOVE_M = 0.01

Blocked = Callable[[Points, Points], NDArray[np.bool_]]
"""Returns whether something opaque blocks each line from points (n, 3) to points (n, 3), (n,)."""


@dataclass(frozen=True, slots=True)
class Body:
    """An object in a scene, as an axis-aligned box in m.

    Attributes:
        low: lowest coordinates.
        high: highest coordinates.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @property
    def corners(self) -> Points:
        """Its corners, shape (8, 3)."""
        ends = np.array([self.low, self.high])
        return np.stack(
            [ends[[i, j, k], [0, 1, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
        )


@dataclass(frozen=True, slots=True)
class View:
    """Position and target of a camera, m."""

    position: tuple[float, float, float]
    target: tuple[float, float, float]


def body_of(points: Points) -> Body:
    """Return the bounding box of points (n, 3), n at least 1."""
    low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return Body(tuple(low), tuple(high))


def fit_view(
    robots: list[Body], things: list[Body], blocked: Blocked, fov_rad: float, aspect: float
) -> View | None:
    """Return a view of all robots and the things near them; of all things without a robot.

    The camera is as close as the field of view allows, where most of its subject is visible: not
    inside furniture, and not behind a wall.

    Args:
        robots: the parts of the robots.
        things: the other objects, without the ground.
        blocked: tells which lines of sight are blocked.
        fov_rad: vertical field of view.
        aspect: width of the picture divided by its height.

    Returns:
        None if the scene is empty.
    """
    subject = _subject(robots, things) if robots else things
    if not subject:
        return None
    corners = np.concatenate([body.corners for body in subject])
    middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    looked_at = _samples(robots or things)
    best, best_score = None, -math.inf
    for cost, direction in sorted(_directions(), key=lambda candidate: candidate[0]):
        if best_score >= 1.0 - cost:
            break
        distance = _distance(corners - middle, direction, fov_rad, aspect)
        position = middle + distance * direction
        score = _seen(position, looked_at, blocked) - cost
        if score > best_score:
            best, best_score = position, score
    assert best is not None
    return View(tuple(best.tolist()), tuple(middle.tolist()))


def _subject(robots: list[Body], things: list[Body]) -> list[Body]:
    """Return the robots, and the things that a picture of them should show, the nearest first."""
    corners = np.concatenate([body.corners for body in robots])
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = max(float(np.linalg.norm(high - low)), MIN_SIZE_M)

    def gap_m(thing: Body) -> float:
        gaps = np.maximum(np.subtract(thing.low, high), low - np.array(thing.high))
        return float(np.linalg.norm(gaps.clip(min=0.0)))

    subject = [*robots]
    widest = body_of(corners)
    for thing in sorted(things, key=gap_m):
        wider = body_of(np.concatenate([widest.corners, thing.corners]))
        spread_m = float(np.linalg.norm(np.subtract(wider.high, wider.low)))
        extent_m = np.subtract(thing.high, thing.low).max()
        is_near = extent_m <= size and gap_m(thing) <= NEAR_FACTOR * size
        if is_near and spread_m <= MAX_SPREAD * size:
            subject.append(thing)
            widest = wider
    return subject


def _directions() -> Iterator[tuple[float, Points]]:
    for i, elevation in enumerate(ELEVATIONS):
        for k, azimuth in enumerate(AZIMUTHS):
            level = math.cos(elevation)
            direction = (level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation))
            yield STEEPER_COST * i + TURNED_COST * k, np.array(direction)


def _distance(corners: Points, direction: Points, fov_rad: float, aspect: float) -> float:
    """Return the distance from the middle at which all corners are in the picture."""
    side = np.cross((0.0, 0.0, 1.0), direction)
    side /= np.linalg.norm(side)
    up = np.cross(direction, side)
    tangent = math.tan(0.5 * fov_rad) / MARGIN
    across = np.abs(corners @ side) / (tangent * aspect)
    along = np.abs(corners @ up) / tangent
    distances = corners @ direction + np.maximum(across, along)
    return max(float(distances.max()), MIN_SIZE_M)


def _samples(bodies: list[Body]) -> Points:
    """Return points of bodies that should be visible: just above the top of each."""
    # A sample is enough for a large world.
    bodies = bodies[:: max(len(bodies) // MAX_SAMPLES, 1)]
    tops = np.array([np.add(body.low, body.high) / 2.0 for body in bodies])
    tops[:, 2] = [body.high[2] + ABOVE_M for body in bodies]
    return tops


def _seen(position: Points, points: Points, blocked: Blocked) -> float:
    """Return the fraction of points that are visible from a position."""
    return 1.0 - float(blocked(points, np.broadcast_to(position, points.shape)).mean())
