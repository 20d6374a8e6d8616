"""Reads Wavefront OBJ files and the colours in their MTL files.

trimesh counts negative indices from the end of the file instead of from the line they stand in,
fills the notches of polygons, and takes every material for opaque.
"""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import LARGEST_BYTES, Color, MeshData, numbers_in
from arm_description.mesh.polygons import triangulated
from arm_node.user_file import read_bytes

CONTINUED = re.compile(rb"\\\r?\n")
AFTER_SLASH = re.compile(rb"/[^\s]*")
UNCOLOURED = (0.4, 0.4, 0.4)
"""Of a material that names no colour."""


def read_obj(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of an OBJ file, one for each material.

    Raises:
        MeshFileError: the file is broken.
    """
    content = read_bytes(path, LARGEST_BYTES)
    if b"\\" in content:
        content = CONTINUED.sub(b" ", content)
    lines = _Lines(content)
    points, colors = _vertices(lines.vertices)
    corners, counts = _corners(lines, len(points))
    triangles, faces = triangulated(points, corners, counts)
    users = np.repeat(np.arange(len(lines.names)), np.diff([*lines.begins, len(counts)]))[faces]
    materials = dict(_materials(path.parent, lines.libraries))
    # The same material may be used in several places.
    parts: dict[bytes | None, list[int]] = {}
    for use, name in enumerate(lines.names):
        parts.setdefault(name, []).append(use)
    return tuple(
        _part(points, triangles[chosen], colors if name is None else None, materials.get(name))
        for name, uses in parts.items()
        if (chosen := np.isin(users, uses)).any()
    )


class _Lines:
    """The lines of a file, sorted by what they are.

    Attributes:
        vertices: what follows `v`.
        faces: what follows `f`.
        known: for each face with a negative index, how many vertices are above it.
        names: the materials in the order of their use, at first None.
        begins: the first face of each use.
        libraries: what follows `mtllib`.
    """

    def __init__(self, content: bytes) -> None:
        self.vertices: list[bytes] = []
        self.faces: list[bytes] = []
        self.known: dict[int, int] = {}
        self.names: list[bytes | None] = [None]
        self.begins = [0]
        self.libraries: list[bytes] = []
        for line in content.splitlines():
            start = line[:2]
            if start == b"v ":
                self.vertices.append(line[2:])
            elif start == b"f ":
                self._add_face(line[2:])
            elif start not in (b"vn", b"vt", b"", b"# "):
                self._sort(line.split(None, 1))

    def _add_face(self, corners: bytes) -> None:
        if b"-" in corners:
            self.known[len(self.faces)] = len(self.vertices)
        self.faces.append(corners)

    def _sort(self, words: list[bytes]) -> None:
        word, rest = words[0] if words else b"", words[1].strip() if len(words) > 1 else b""
        if word == b"v":
            self.vertices.append(rest)
        elif word in (b"f", b"fo"):
            self._add_face(rest)
        elif word == b"usemtl":
            self.names.append(rest)
            self.begins.append(len(self.faces))
        elif word == b"mtllib":
            self.libraries.append(rest)


def _vertices(lines: list[bytes]) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Return the points, shape (v, 3), and their colours, shape (v, 3), if all have one."""
    width = len(lines[0].split()) if lines else 3
    table = numbers_in(b"\n".join(lines), "a coordinate", np.float64)
    if width < 3 or len(table) != width * len(lines):
        rows = [line.split() for line in lines]
        if min(map(len, rows)) < 3:
            raise MeshFileError("a vertex lacks coordinates, or a face is not a triangle")
        width = 3
        table = numbers_in(
            b" ".join(b" ".join(row[:3]) for row in rows), "a coordinate", np.float64
        )
    table = table.reshape(-1, width)
    # A fourth number is a weight, which means nothing outside curves; three more are a colour.
    return table[:, :3], table[:, -3:] if width >= 6 else None


def _corners(lines: _Lines, points: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the vertices of all faces, from 0, and how many each face has."""
    counts = np.array([len(face.split()) for face in lines.faces], dtype=np.int64)
    given = _first_numbers(lines.faces, counts)
    if len(given) != counts.sum():
        raise MeshFileError("a face has a vertex that is not a number")
    above = np.full(len(counts), points)
    above[list(lines.known)] = list(lines.known.values())
    corners = np.where(given < 0, given + np.repeat(above, counts), given - 1)
    if len(corners) and (corners.min() < 0 or corners.max() >= points):
        raise MeshFileError("a triangle has a vertex that does not exist")
    return corners, counts


def _first_numbers(faces: list[bytes], counts: NDArray[np.int64]) -> NDArray[Any]:
    """Return the number before the first slash of each corner: v, v/vt, v//vn or v/vt/vn."""
    text = b"\n".join(faces)
    slashes = faces[0].split()[0].count(b"/") if len(counts) and counts[0] else 0
    if b"/" not in text:
        return numbers_in(text, "a face's vertex", np.int64)
    if [face.count(b"/") for face in faces] == (slashes * counts).tolist():
        table = numbers_in(
            text.replace(b"//", b"/0/").replace(b"/", b" "), "a face's vertex", np.int64
        )
        if len(table) == (slashes + 1) * counts.sum():
            return table[:: slashes + 1]
    return numbers_in(AFTER_SLASH.sub(b"", text), "a face's vertex", np.int64)


def _part(
    points: NDArray[np.float64],
    triangles: NDArray[np.int64],
    colors: NDArray[np.float64] | None,
    rgba: Color | None,
) -> MeshData:
    used, faces = np.unique(triangles, return_inverse=True)
    if colors is not None:
        each, often = np.unique(colors[used], axis=0, return_counts=True)
        red, green, blue = each[np.argmax(often)].tolist()
        rgba = (red, green, blue, 1.0)
    return MeshData(points[used], faces.reshape(-1, 3).astype(np.int32), rgba)


def material_files(folder: Path, names: Iterable[bytes]) -> Iterator[bytes]:
    """Yield the contents of the MTL files that `mtllib` lines name; those that are missing as b"".

    Args:
        folder: of the OBJ file; files outside it and below are left out.
        names: what follows `mtllib`: one name with blanks, or several names.
    """
    for line in names:
        whole = _side_file(folder, line)
        if whole is None and len(line.split()) > 1:
            yield from ((_side_file(folder, name) or b"") for name in line.split())
        else:
            yield whole or b""


def _side_file(folder: Path, name: bytes) -> bytes | None:
    path = (folder / name.decode("utf-8", "replace").replace("\\", "/")).resolve()
    try:
        inside = path.is_relative_to(folder.resolve())
        return read_bytes(path, LARGEST_BYTES) if inside else None
    except (OSError, ValueError):
        return None


def _materials(folder: Path, libraries: Iterable[bytes]) -> Iterator[tuple[bytes | None, Color]]:
    """Yield the materials by name; a broken number leaves its colour as it is without one."""
    for content in material_files(folder, libraries):
        for block in re.split(rb"^\s*newmtl\b", content, flags=re.MULTILINE)[1:]:
            name, *rest = block.splitlines()
            values = {words[0]: words[1:] for line in rest if (words := line.split())}
            diffuse = _floats(values.get(b"Kd", ()))
            red, green, blue = diffuse if len(diffuse) == 3 else UNCOLOURED
            yield name.strip(), (red, green, blue, _opacity(values))


def _opacity(values: dict[bytes, list[bytes]]) -> float:
    """Return how opaque a material is, by `d`, or by `Tr`, which counts the other way round."""
    dissolve, transparency = (_floats(values.get(key, ())[-1:]) for key in (b"d", b"Tr"))
    if dissolve:
        return min(max(dissolve[0], 0.0), 1.0)
    return min(max(1.0 - transparency[0], 0.0), 1.0) if transparency else 1.0


def _floats(words: Iterable[bytes]) -> list[float]:
    try:
        values = [float(word) for word in words]
    except ValueError:
        return []
    return values if np.isfinite(values).all() else []
