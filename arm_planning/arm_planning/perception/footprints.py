"""Circles and rectangles as seen from above, fitted to what a camera sees of upright things.

All points are in the plane of the support; the camera is above its origin.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ITERATIONS = 12
CONVERGED = 1e-4
"""Relative gain of a step below which the fit is done."""
HUBER = 1.5
"""Residual, in standard deviations, from which on a piece of evidence counts less."""
TURNS = np.linspace(0, pi / 2, 30, endpoint=False)
"""Yaws that a rectangle's fit tries first, in rad."""
FAR_M = 0.004
"""Distance from which on a point counts no more while yaws are compared."""
LEAST_M = 0.002
"""Smallest radius or half side."""


@dataclass(frozen=True, slots=True)
class OutlineEvidence:
    """What is seen of one thing.

    Attributes:
        walls: points of its upright faces, (n, 2), in m.
        wall_noise: standard deviation of a wall's point, in m.
        rim: points of its top's outline where nothing hides it, (m, 2), in m.
        rim_noise: standard deviation of a point of the rim, in m.
        edges: lines from the camera that its left and right edge are on, as far as they are seen:
            unit normals away from the thing, (0 to 2, 2).
        edge_noise: standard deviation of an edge from its line, in m.
    """

    walls: Array
    wall_noise: float
    rim: Array
    rim_noise: float
    edges: Array
    edge_noise: float

    def points(self) -> Array:
        """Return all points, (n + m, 2)."""
        return np.concatenate([self.walls, self.rim])


@dataclass(frozen=True, slots=True)
class Circle:
    """The footprint of an upright cylinder, in m."""

    x: float
    y: float
    radius: float

    def distances(self, points: Array) -> Array:
        """Return the distances (n,) of points (n, 2) from it, negative inside."""
        return np.hypot(points[:, 0] - self.x, points[:, 1] - self.y) - self.radius

    def slopes(self, points: Array) -> Array:
        """Return how the distances change with x, y and radius, (n, 3)."""
        offsets = np.array([self.x, self.y]) - points
        lengths = np.maximum(np.hypot(offsets[:, 0], offsets[:, 1]), 1e-9)
        return np.column_stack([offsets / lengths[:, None], np.full(len(points), -1.0)])

    def reach(self, normals: Array) -> Array:
        """Return how far it reaches from the origin along unit vectors (n, 2)."""
        return normals @ (self.x, self.y) + self.radius

    def reach_slopes(self, normals: Array) -> Array:
        """Return how the reach changes with x, y and radius, (n, 3)."""
        return np.column_stack([normals, np.ones(len(normals))])


@dataclass(frozen=True, slots=True)
class Rectangle:
    """The footprint of an upright box: half sides along and across its yaw, in m and rad."""

    x: float
    y: float
    yaw: float
    along: float
    across: float

    def local(self, points: Array) -> tuple[Array, Array]:
        """Return points (n, 2) along and across the yaw, from the centre."""
        return self._turned(points - np.array([self.x, self.y]))

    def distances(self, points: Array) -> Array:
        """Return the distances (n,) of points (n, 2) from the lines of the sides, negative inside.

        Before a corner the distance is that from the farther line.
        """
        u, v = self.local(points)
        return np.maximum(np.abs(u) - self.along, np.abs(v) - self.across)

    def slopes(self, points: Array) -> Array:
        """Return how the distances change with x, y, yaw and the half sides, (n, 5)."""
        u, v = self.local(points)
        c, s = cos(self.yaw), sin(self.yaw)
        ends = np.abs(u) - self.along > np.abs(v) - self.across
        sign = np.sign(np.where(ends, u, v))
        return np.column_stack(
            [
                sign * np.where(ends, -c, s),
                sign * np.where(ends, -s, -c),
                sign * np.where(ends, v, -u),
                np.where(ends, -1.0, 0.0),
                np.where(ends, 0.0, -1.0),
            ]
        )

    def reach(self, normals: Array) -> Array:
        """Return how far it reaches from the origin along unit vectors (n, 2)."""
        u, v = self._turned(normals)
        return normals @ (self.x, self.y) + np.abs(u) * self.along + np.abs(v) * self.across

    def reach_slopes(self, normals: Array) -> Array:
        """Return how the reach changes with x, y, yaw and the half sides, (n, 5)."""
        u, v = self._turned(normals)
        by_yaw = np.sign(u) * v * self.along - np.sign(v) * u * self.across
        return np.column_stack([normals, by_yaw, np.abs(u), np.abs(v)])

    def _turned(self, vectors: Array) -> tuple[Array, Array]:
        c, s = cos(self.yaw), sin(self.yaw)
        x, y = vectors.T
        return c * x + s * y, c * y - s * x


Footprint = Circle | Rectangle


@dataclass(frozen=True, slots=True)
class Fit:
    """A footprint and how well it explains the evidence.

    Attributes:
        shape: the footprint.
        error: root mean square of the residuals, each in its standard deviations.
    """

    shape: Footprint
    error: float


def fit_circle(evidence: OutlineEvidence) -> Fit:
    """Return the circle that explains the evidence best; at least 3 points."""
    points = evidence.points()
    centre = points.mean(axis=0)
    # |p|² = 2 c·p + (r² - c²) is linear in c and in the bracket.
    local = points - centre
    system = np.column_stack([2 * local, np.ones(len(local))])
    x, y, rest = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0]
    radius, spread = float(np.sqrt(max(rest + x * x + y * y, 0))), float(np.abs(local).max())
    if radius > 2 * spread:
        x, y, radius = 0.0, 0.0, spread
    start = np.array([centre[0] + x, centre[1] + y, radius])
    return _refined(start, _circle, evidence)


def fit_rectangle(evidence: OutlineEvidence) -> Fit:
    """Return the rectangle that explains the evidence best; at least 3 points."""
    points = evidence.points()
    c, s = np.cos(TURNS)[:, None], np.sin(TURNS)[:, None]
    x, y = points.T
    turned = np.stack([c * x + s * y, c * y - s * x])
    low, high = np.quantile(turned, (0.02, 0.98), axis=2)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    gaps = (np.abs(turned - middle[..., None]) - half[..., None]).max(axis=0)
    best = int(np.minimum(np.abs(gaps), FAR_M).mean(axis=1).argmin())
    (u, v), turn = middle[:, best], TURNS[best]
    place = (cos(turn) * u - sin(turn) * v, sin(turn) * u + cos(turn) * v)
    return _refined(np.array([*place, turn, *half[:, best]]), _rectangle, evidence)


def _circle(q: Array) -> Circle:
    return Circle(q[0], q[1], max(q[2], LEAST_M))


def _rectangle(q: Array) -> Rectangle:
    return Rectangle(q[0], q[1], q[2], max(q[3], LEAST_M), max(q[4], LEAST_M))


def _refined(start: Array, shape: Callable[[Array], Footprint], evidence: OutlineEvidence) -> Fit:
    """Return the footprint after robust Levenberg-Marquardt steps from a start."""
    q, damping = start, 1e-3
    residuals = _residuals(shape(q), evidence)
    cost = _cost(residuals)
    for _ in range(ITERATIONS):
        weights = np.sqrt(np.minimum(1, HUBER / np.maximum(np.abs(residuals), 1e-9)))
        slopes = _slopes(shape(q), evidence) * weights[:, None]
        normal = slopes.T @ slopes
        bound = np.diag(damping * normal.diagonal() + 1e-3)
        tried = q - np.linalg.solve(normal + bound, slopes.T @ (weights * residuals))
        tried_residuals = _residuals(shape(tried), evidence)
        tried_cost = _cost(tried_residuals)
        if tried_cost > cost:
            damping *= 10
            continue
        gain = cost - tried_cost
        q, residuals, cost, damping = tried, tried_residuals, tried_cost, damping * 0.3
        if gain < CONVERGED * cost:
            break
    return Fit(shape(q), float(np.sqrt(cost / max(len(residuals), 1))))


def _residuals(shape: Footprint, evidence: OutlineEvidence) -> Array:
    """Return the misfit of each piece of evidence, in its standard deviations."""
    return np.concatenate(
        [
            shape.distances(evidence.walls) / evidence.wall_noise,
            shape.distances(evidence.rim) / evidence.rim_noise,
            shape.reach(evidence.edges) / evidence.edge_noise,
        ]
    )


def _slopes(shape: Footprint, evidence: OutlineEvidence) -> Array:
    """Return how the residuals change with the shape's parameters."""
    return np.concatenate(
        [
            shape.slopes(evidence.walls) / evidence.wall_noise,
            shape.slopes(evidence.rim) / evidence.rim_noise,
            shape.reach_slopes(evidence.edges) / evidence.edge_noise,
        ]
    )


def _cost(residuals: Array) -> float:
    """Return the sum of Huber's losses."""
    size = np.abs(residuals)
    return float(np.where(size < HUBER, size**2, HUBER * (2 * size - HUBER)).sum())
