"""How far a point is outside of a shape."""

import math

import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import rotation_from_quaternion
from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

Array = NDArray[np.float64]

INSIDE_MESH = 0.5
"""Share of the sphere of directions from which a closed surface encloses a point inside of it."""


def local_point(region: PlacedShape, point: Array) -> Array:
    """Return a point, (3,), in the frame of a region that is placed in the same frame."""
    rotation = rotation_from_quaternion(np.array(region.pose.rotation))
    return (point - np.array(region.pose.position)) @ rotation


def distance_outside(shape: Shape, point: Array) -> float:
    """Return the distance in m from a point in the shape's frame, (3,), to the shape; 0 inside.

    A mesh is the volume inside of its surface.
    """
    match shape:
        case Sphere():
            return max(float(np.linalg.norm(point)) - shape.radius, 0.0)
        case Box():
            return float(np.linalg.norm(np.maximum(np.abs(point) - np.array(shape.size) / 2, 0.0)))
        case Cylinder():
            radial, along = _radial(point), abs(float(point[2]))
            return math.hypot(max(radial - shape.radius, 0.0), max(along - shape.length / 2.0, 0.0))
        case Cone():
            return _outside_cone(shape, _radial(point), float(point[2]))
        case Plane():
            normal = np.array([shape.a, shape.b, shape.c])
            return max(float(normal @ point + shape.d) / float(np.linalg.norm(normal)), 0.0)
        case TriangleMesh():
            corners = shape.vertices[shape.triangles]
            return 0.0 if _encloses(corners, point) else _distance_to_surface(corners, point)


def describe_shape(shape: Shape) -> str:
    """Return a shape in words."""
    match shape:
        case Sphere():
            return f"a sphere of radius {_millimetres(shape.radius)}"
        case Box():
            return f"a box of {' x '.join(_millimetres(side) for side in shape.size)}"
        case Cylinder():
            return (
                f"a cylinder of radius {_millimetres(shape.radius)} and length "
                f"{_millimetres(shape.length)}"
            )
        case Cone():
            return (
                f"a cone of radius {_millimetres(shape.radius)} and height "
                f"{_millimetres(shape.height)}"
            )
        case Plane():
            return "a half space"
        case TriangleMesh():
            return f"a mesh of {len(shape.triangles)} triangles"


def _millimetres(length_m: float) -> str:
    return f"{1000.0 * length_m:.3g} mm"


def _radial(point: Array) -> float:
    return math.hypot(float(point[0]), float(point[1]))


def _outside_cone(cone: Cone, radial: float, along: float) -> float:
    """Distance in the half plane of the axis and the point, where the cone is a triangle."""
    half = cone.height / 2.0
    slant = math.hypot(cone.radius, cone.height)
    # Along the side from the tip, and away from it.
    down = (radial * cone.radius + (half - along) * cone.height) / slant
    away = (radial * cone.height + (along - half) * cone.radius) / slant
    if away <= 0.0 and along >= -half:
        return 0.0
    to_base = math.hypot(max(radial - cone.radius, 0.0), along + half)
    to_side = math.hypot(away, max(-down, down - slant, 0.0))
    return min(to_base, to_side)


def _encloses(corners: Array, point: Array) -> bool:
    """Whether the triangles, (m, 3, 3), enclose a point, by their solid angles.

    A. van Oosterom, J. Strackee: The solid angle of a plane triangle, 1983. Their sum is 4 pi
    inside a closed surface and 0 outside, whichever way the surface faces.
    """
    a, b, c = np.moveaxis(corners - point, 1, 0)
    na, nb, nc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    rest = (
        na * nb * nc
        + np.einsum("ij,ij->i", a, b) * nc
        + np.einsum("ij,ij->i", b, c) * na
        + np.einsum("ij,ij->i", c, a) * nb
    )
    share = float(np.arctan2(volume, rest).sum()) / (2.0 * math.pi)
    return abs(share) > INSIDE_MESH


def _distance_to_surface(corners: Array, point: Array) -> float:
    """Distance from a point to the nearest of the triangles, (m, 3, 3)."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    flat = area > 0.0
    unit = normal[flat] / area[flat][:, None]
    inside = np.ones(len(unit), dtype=bool)
    for first, second in ((a, b), (b, c), (c, a)):
        edge = (second - first)[flat]
        inside &= np.einsum("ij,ij->i", np.cross(edge, point - first[flat]), unit) >= 0.0
    heights = np.abs(np.einsum("ij,ij->i", unit, point - a[flat]))[inside]
    edges = min(_distance_to_segments(p, q, point) for p, q in ((a, b), (b, c), (c, a)))
    return min(edges, float(heights.min(initial=math.inf)))


def _distance_to_segments(start: Array, end: Array, point: Array) -> float:
    direction = end - start
    length = np.einsum("ij,ij->i", direction, direction)
    along = np.einsum("ij,ij->i", point - start, direction) / np.where(length > 0.0, length, 1.0)
    nearest = start + np.clip(along, 0.0, 1.0)[:, None] * direction
    return float(np.linalg.norm(point - nearest, axis=1).min())
