"""Meshes as convex pieces, because MuJoCo collides convex shapes only.

* A mesh file of a link: the convex hulls of its connected parts, or one hull if they are many.
* A mesh of an object: each connected part that is closed and convex is one piece and is solid.
  Every other part is a surface: each of its triangles is a thin plate. So a concave box is not
  filled up, but what is wholly inside of a closed surface does not touch it.
"""

import hashlib
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar, cast

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError, ResourceNotFoundError
from arm_description.mesh.file import check_mesh_file, read_mesh_file
from arm_description.resources import ResourceFinder
from arm_description.urdf.robot import Mesh
from arm_planning.errors import InvalidObjectError, MoveItErrorCode, PlanningError
from arm_planning.scene.shapes import TriangleMesh

Array = NDArray[np.float64]
ThingT = TypeVar("ThingT")
PartT = TypeVar("PartT")
KeyT = TypeVar("KeyT")
Pieces = tuple[Array, ...]
"""The corners of each convex piece, shapes (n, 3), m."""

HALF_PLATE_M = 5e-5
"""Half the thickness of a plate, which a triangle or a flat part of a mesh becomes."""
MAX_PLATES = 5_000
"""Most triangles of an object's mesh that are plates: each is a shape of the model."""
MAX_REMEMBERED = 1_000
CONVEX_WITHIN = 1e-6
"""How far a corner may stand out of a face of a convex part, in parts of the part's size."""
FLAT = 1e-6
"""Ratio of thickness to size below which a part is flat."""
SHARP = 1e-6
"""Determinant of the normals around a corner, of trace 1, above which it is one for certain: so it
is where faces are tilted by some 2 degrees."""
NEAR = 1e-3
"""Part of a mesh's distance from its frame that its size must have for single precision, which
MuJoCo has, to tell its corners from each other."""
SAME_PLACE = 1e-9
"""Distance below which corners are one corner, in parts of the mesh's size."""
PRODUCTS_AT_ONCE = 4_000_000
MAX_LINK_PIECES = 8
"""Most pieces of a part of a link's mesh: each takes time in every check."""
MAX_LINK_PARTS = 200
"""Most connected parts that are looked at: each hull takes some milliseconds."""
INSIDE_M = 1e-6
"""How far a part may stand out of a piece that covers it, m."""


class MeshPieces:
    """Cuts meshes into convex pieces, and remembers them, and the shapes of links and objects.

    Keep one for all the models of a robot: reading and cutting a mesh takes much longer than the
    rest of a model. Any thread may use it; two at a time may cut the same mesh twice.

    Args:
        resources: finds the mesh files of links.
    """

    def __init__(self, resources: ResourceFinder | None = None) -> None:
        self._resources = resources or ResourceFinder()
        self._known: dict[object, Pieces] = {}
        self._of: dict[int, tuple[object, tuple[object, ...]]] = {}
        self._lock = threading.Lock()

    def of_file(self, mesh: Mesh) -> Pieces:
        """Return the hulls of the parts of a link's mesh file, scaled.

        Raises:
            PlanningError: the file is missing or cannot be used; the message names it.
        """
        return self._remembered((mesh.uri, mesh.scale), lambda: self._read(mesh))

    def of_object(self, mesh: TriangleMesh) -> Pieces:
        """Return the pieces of an object's mesh.

        Raises:
            PlanningError: it is not a mesh, or has too many triangles.
        """
        content = hashlib.blake2b(np.ascontiguousarray(mesh.vertices).tobytes())
        content.update(np.ascontiguousarray(mesh.triangles).tobytes())
        return self._remembered(content.digest(), lambda: convex_pieces(mesh))

    def of(self, thing: ThingT, make: Callable[[ThingT], tuple[PartT, ...]]) -> tuple[PartT, ...]:
        """Return what was made of an unchanging thing, made now if this is the first time."""
        known = self._of.get(id(thing))
        if known is None:
            # The thing is kept, so that no other gets its id.
            known = (thing, make(thing))
            with self._lock:
                _remember(self._of, id(thing), known)
        return cast(tuple[PartT, ...], known[1])

    def _remembered(self, key: object, make: Callable[[], Pieces]) -> Pieces:
        known = self._known.get(key)
        if known is None:
            known = make()
            with self._lock:
                _remember(self._known, key, known)
        return known

    def _read(self, mesh: Mesh) -> Pieces:
        try:
            path = self._resources.find(mesh.uri)
            check_mesh_file(path)
            parts = read_mesh_file(path)
        except (ResourceNotFoundError, MeshFileError, OSError) as error:
            message = f"cannot use the mesh {mesh.uri}: {error}"
            raise PlanningError(MoveItErrorCode.COLLISION_CHECKING_UNAVAILABLE, message) from error
        return tuple(
            piece
            for part in parts
            if len(part.vertices)
            for piece in link_pieces(part.vertices * np.asarray(mesh.scale), part.faces)
        )


def _remember(known: dict[KeyT, ThingT], key: KeyT, thing: ThingT) -> None:
    if len(known) >= MAX_REMEMBERED:
        known.pop(next(iter(known)))
    known[key] = thing


def link_pieces(vertices: Array, triangles: NDArray[np.int32]) -> Pieces:
    """Cover a part of a link's mesh with convex pieces.

    One hull around a tube with a joint at each end fills the space beside the tube, through which
    other links pass.

    Args:
        vertices: (n, 3), m.
        triangles: indices of the corners of each, (m, 3).

    Raises:
        PlanningError: MuJoCo finds no hull.
    """
    corners, joined = vertices, triangles.astype(np.int64)
    # Some formats give each triangle corners of its own; a closed mesh has half as many as those.
    if len(vertices) > len(triangles):
        corners, joined = _merged(TriangleMesh(vertices, joined))
    parts = _parts(joined, len(corners))
    if 1 < len(parts) <= MAX_LINK_PARTS:
        pieces = _covering([corners[np.unique(part)] for part in parts])
        if len(pieces) <= MAX_LINK_PIECES:
            return tuple(piece.corners for piece in pieces)
    return (hull(vertices),)


def _covering(clouds: list[Array]) -> "list[Hull]":
    """Return hulls that cover all points; it stops where they are too many."""
    pieces: list[Hull] = []
    for cloud in sorted(clouds, key=lambda each: -float(np.ptp(each, axis=0).max())):
        if not any(piece.contains(cloud) for piece in pieces):
            pieces.append(convex_hull(cloud))
        if len(pieces) > MAX_LINK_PIECES:
            break
    return pieces


def convex_pieces(mesh: TriangleMesh) -> Pieces:
    """Cut a mesh into convex pieces.

    Raises:
        PlanningError: it has no triangles or broken ones, or too many that need plates.
    """
    corners, triangles = _merged(mesh)
    pieces: list[Array] = []
    plates: list[Array] = []
    for part in _parts(triangles, len(corners)):
        used, local = np.unique(part, return_inverse=True)
        points, faces = corners[used], local.reshape(-1, 3)
        if _is_closed(part) and _is_convex(points, *(found := _normals(points, faces))):
            # MuJoCo's hull takes most of the time; it leaves out what lies between corners.
            pieces.append(points if _are_corners(points, *found) else hull(points))
        else:
            plates.extend(thickened(corner) for corner in corners[part])
    if len(plates) > MAX_PLATES:
        raise InvalidObjectError(
            f"the mesh has {len(plates)} triangles in parts that are not convex; at most "
            f"{MAX_PLATES} are checked; simplify it or cut it into convex parts"
        )
    return (*pieces, *plates)


@dataclass(frozen=True, slots=True, eq=False)
class Hull:
    """A convex body.

    Attributes:
        corners: (n, 3), m.
        normals: of its faces, outwards, (m, 3).
        heights: of its faces along their normals, (m,).
    """

    corners: Array
    normals: Array
    heights: Array

    def contains(self, points: Array) -> bool:
        """Return whether all points (n, 3) are in it."""
        return bool((points @ self.normals.T <= self.heights + INSIDE_M).all())


def hull(points: Array) -> Array:
    """Return the corners of the convex hull of points; see `convex_hull`."""
    return convex_hull(points).corners


def convex_hull(points: Array) -> Hull:
    """Return the convex hull of points, (n, 3); flat points get a thickness.

    Raises:
        PlanningError: MuJoCo finds none.
    """
    points = thickened(points)
    spec = mujoco.MjSpec()
    spec.add_mesh(
        name="hull",
        uservert=points.ravel(),
        # The hull is of the points; but MuJoCo refuses a mesh whose triangles have no area.
        userface=_wide_triangle(points),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="hull")
    try:
        model = spec.compile()
    except ValueError as error:
        raise InvalidObjectError(
            f"the mesh cannot be used: MuJoCo finds no convex hull of a part: {error}"
        ) from error
    # Counts of corners and faces, two arrays of a number per corner, the edges, then the faces.
    count, faces = (int(number) for number in model.mesh_graph[:2])
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.mesh_quat[0])
    placed = model.mesh_vert.astype(np.float64) @ rotation.reshape(3, 3).T + model.mesh_pos[0]
    corners = placed[model.mesh_graph[2 + count : 2 + 2 * count]]
    a, b, c = placed[model.mesh_graph[-3 * faces :].reshape(-1, 3).T]
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    solid = lengths > 0.0
    normals = normals[solid] / lengths[solid, None]
    heights = np.einsum("ij,ij->i", normals, a[solid])
    inwards = normals @ corners.mean(axis=0) > heights
    normals[inwards] *= -1.0
    heights[inwards] *= -1.0
    return Hull(corners, normals, heights)


def _wide_triangle(points: Array) -> NDArray[np.int32]:
    """Return the indices of three points that are far apart and not in a line."""
    first = points - points[0]
    second = int(np.einsum("ij,ij->i", first, first).argmax())
    beside = np.cross(first, first[second])
    third = int(np.einsum("ij,ij->i", beside, beside).argmax())
    return np.array([0, second, third], np.int32)


def thickened(points: Array) -> Array:
    """Return points with a volume: those in a plane become a plate, those in a line a rod."""
    spread = points - points.mean(axis=0)
    _, axes = np.linalg.eigh(spread.T @ spread)
    sizes = np.ptp(spread @ axes, axis=0)
    for axis in axes.T[sizes <= max(FLAT * float(sizes.max()), 1e-7)]:
        points = np.concatenate([points - HALF_PLATE_M * axis, points + HALF_PLATE_M * axis])
    return points


def _merged(mesh: TriangleMesh) -> tuple[Array, NDArray[np.int64]]:
    """Return corners at different places and the triangles between them that have an area."""
    vertices, triangles = mesh.vertices, mesh.triangles
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or triangles.shape[1:] != (3,):
        raise _broken("its vertices or triangles do not have three numbers each")
    if not len(triangles) or not len(vertices):
        raise _broken("it has no triangles")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise _broken(f"a triangle has a corner that is not among its {len(vertices)} vertices")
    if not np.isfinite(vertices).all():
        raise _broken("a vertex is not finite")
    size = float(np.ptp(vertices, axis=0).max())
    if size <= 0.0:
        raise _broken("all its vertices are at one place")
    grid = np.round((vertices - vertices.min(axis=0)) / (size * SAME_PLACE)).astype(np.int64)
    _, first, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    joined = place.reshape(-1)[triangles]
    a, b, c = joined.T
    joined = joined[(a != b) & (b != c) & (c != a)]
    if not len(joined):
        raise _broken("all its triangles are without an area")
    return vertices[first], joined


def _parts(triangles: NDArray[np.int64], corners: int) -> list[NDArray[np.int64]]:
    """Return the triangles of each connected part."""
    label = np.arange(corners)
    while True:
        lowest = label[triangles].min(axis=1)
        lower = label.copy()
        for corner in triangles.T:
            np.minimum.at(lower, corner, lowest)
        lower = lower[lower]
        if (lower == label).all():
            break
        label = lower
    of_triangle = label[triangles[:, 0]]
    order = np.argsort(of_triangle, kind="stable")
    cuts = np.flatnonzero(np.diff(of_triangle[order])) + 1
    return np.split(triangles[order], cuts)


def _is_closed(triangles: NDArray[np.int64]) -> bool:
    """Return whether each edge belongs to two triangles."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return bool((counts == 2).all())


def _is_convex(points: Array, normals: Array, triangles: NDArray[np.int64]) -> bool:
    """Return whether all points lie on one side of each triangle."""
    size = float(np.ptp(points, axis=0).max())
    a = points[triangles[:, 0]]
    rows = max(1, PRODUCTS_AT_ONCE // len(points))
    for start in range(0, len(normals), rows):
        normal = normals[start : start + rows]
        heights = normal @ points.T - np.sum(normal * a[start : start + rows], axis=1)[:, None]
        out, inward = heights.max(axis=1), -heights.min(axis=1)
        if (np.minimum(out, inward) > CONVEX_WITHIN * size).any():
            return False
    return True


def _normals(points: Array, triangles: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
    """Return unit normals, (k, 3), and their triangles.

    A sliver has no direction to judge by; its neighbours are judged.
    """
    a, b, c = (points[corner] for corner in triangles.T)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    size = float(np.ptp(points, axis=0).max())
    solid = lengths > FLAT * size * size * FLAT
    return normals[solid] / lengths[solid, None], triangles[solid]


def _are_corners(points: Array, normals: Array, triangles: NDArray[np.int64]) -> bool:
    """Return whether each point of a convex surface is a corner of it for certain."""
    if float(np.ptp(points, axis=0).max()) < NEAR * float(np.abs(points).max()):
        return False
    around = np.zeros((len(points), 3, 3))
    products = normals[:, :, None] * normals[:, None, :]
    for corner in triangles.T:
        np.add.at(around, corner, products)
    # The trace is the number of triangles.
    count = np.trace(around, axis1=1, axis2=2)
    return bool((np.linalg.det(around) > SHARP * count**3).all())


def _broken(reason: str) -> PlanningError:
    return InvalidObjectError(f"the mesh cannot be used: {reason}")
