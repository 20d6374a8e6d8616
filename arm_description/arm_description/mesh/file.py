"""Reads mesh files of every kind that a description may name.

STL and OBJ files have their own readers, without a mesh library, which takes long to import.
trimesh reads the others: .dae .glb .gltf .ply .off .3mf.
"""

import io
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import LARGEST_BYTES, Color, MeshData, merged
from arm_description.mesh.obj import read_obj
from arm_description.mesh.polygons import notched
from arm_node.user_file import check_file, read_bytes

FACES_DIFFER = "; if its faces have different numbers of corners, export it as triangles"
PICTURES = (".png", ".jpg", ".jpeg", ".tga", ".tif", ".tiff", ".bmp", ".gif", ".dds", ".webp")
HINTS = {".ply": FACES_DIFFER, ".off": FACES_DIFFER}
"""What trimesh's own message does not say."""


def read_scene(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of a mesh file in m, one for each material.

    Raises:
        MeshFileError: trimesh cannot read the file, or it would draw too much.
    """
    suffix = path.suffix.lower()
    content, unit = _checked_content(path)
    # trimesh takes half a second to import, and STL files do not need it.
    import trimesh

    try:
        if suffix == ".off":
            _refuse_notches(*_off_polygons(content))
        scene = trimesh.load_scene(
            io.BytesIO(content),
            file_type=suffix.removeprefix("."),
            resolver=_side_files(path),
            process=False,
            group_material=True,
        )
        parts = tuple(
            _part(mesh, transform, unit)
            for mesh, transform in _placed(scene)
            if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) and not _has_notches(mesh)
        )
    except MeshFileError:
        raise
    except Exception as error:
        # Each of trimesh's loaders raises its own exceptions, and any of them for a broken file.
        hint = HINTS.get(suffix, "")
        raise MeshFileError(f"{type(error).__name__}: {error}{hint}") from error
    return parts


def _checked_content(path: Path) -> tuple[bytes, float]:
    """Return a file's bytes, corrected where trimesh would read them wrongly, and its unit in m."""
    # The readers are imported here, because most robots have STL files only.
    match path.suffix.lower():
        case ".gltf" | ".glb":
            from arm_description.mesh.gltf import read_gltf

            return read_gltf(path), 1.0
        case ".dae":
            from arm_description.mesh.collada import read_collada

            return read_collada(path)
        case ".3mf":
            from arm_description.mesh.packed import read_packed

            return read_packed(path)
        case _:
            return read_bytes(path, LARGEST_BYTES), 1.0


def _side_files(mesh: Path) -> Any:
    """Return what gives trimesh the regular files beside or below a mesh, except pictures.

    They are materials of an .obj or data of a .gltf. Parts of a robot have one colour each, so
    pictures are not needed.
    """
    from trimesh.resolvers import FilePathResolver

    class SideFiles(FilePathResolver):
        def get(self, name: str) -> bytes:
            """Return the content of a file; raise OSError, or ValueError outside the folder."""
            path = self.absolute(name)
            if path.suffix.lower() in PICTURES:
                raise FileNotFoundError(f"the picture {path} is not needed")
            return read_bytes(path, LARGEST_BYTES)

    return SideFiles(str(mesh))


def _has_notches(mesh: Any) -> bool:
    """Refuse a PLY file's polygons with notches, which trimesh fills; return False for all others.

    Raises:
        MeshFileError: a face has a notch.
    """
    data = mesh.metadata.get("_ply_raw", {}).get("face", {}).get("data", {})
    for name in ("vertex_indices", "vertex_index"):
        if name not in (data if isinstance(data, dict) else data.dtype.names):
            continue
        # Lists of numbers, or in a binary file a table with the number of corners before them.
        rows = data[name]
        rows = rows["f1"] if rows.dtype.names else rows
        if len(rows) < len(mesh.faces):
            _refuse_notches(mesh.vertices, rows)
    return False


def _off_polygons(content: bytes) -> tuple[NDArray[np.float64], list[NDArray[np.int64]]]:
    """Return the points of an OFF file, shape (p, 3), and the points' indices of each face."""
    words = (line.partition(b"#")[0].split() for line in content.splitlines())
    lines = [line for line in words if line]
    counts = lines.pop(0)[1:] or lines.pop(0)
    points, faces = int(counts[0]), int(counts[1])
    rows = lines[points : points + faces]
    return (
        np.array([line[:3] for line in lines[:points]], np.float64),
        [np.array(row[1 : int(row[0]) + 1], np.int64) for row in rows],
    )


def _refuse_notches(points: NDArray[np.float64], polygons: Iterable[NDArray[np.int64]]) -> None:
    if notched(points, polygons):
        raise MeshFileError("a face has a notch; export the mesh as triangles")


def _placed(scene: Any) -> Iterator[tuple[Any, NDArray[np.float64]]]:
    """Yield each geometry of a trimesh scene and where it stands.

    `scene.dump()` copies each mesh, and the copy of one with coloured faces needs SciPy.
    """
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        yield scene.geometry[geometry], transform


def _part(mesh: Any, transform: NDArray[np.float64], unit: float) -> MeshData:
    rotation, translation = transform[:3, :3], transform[:3, 3]
    vertices = np.asarray(mesh.vertices, dtype=np.float64) @ rotation.T + translation
    faces = np.asarray(mesh.faces, dtype=np.int32)
    if np.linalg.det(rotation) < 0.0:
        # A mirror image is turned inside out.
        faces = faces[:, ::-1]
    return MeshData(vertices * unit, faces, _color(mesh.visual))


def _color(visual: Any) -> Color | None:
    material = getattr(visual, "material", None)
    if material is not None:
        rgba = np.asarray(material.main_color, dtype=np.float64) / 255
    elif getattr(visual, "defined", False):
        rgba = np.asarray(visual.main_color, dtype=np.float64) / 255
    else:
        return None
    return (float(rgba[0]), float(rgba[1]), float(rgba[2]), float(rgba[3]))


STL_SUFFIX = ".stl"
PACKED_SUFFIX = ".3mf"
OBJ_SUFFIX = ".obj"
SCENE_SUFFIXES = (".dae", ".glb", ".gltf", ".ply", ".off", PACKED_SUFFIX)


def check_mesh_file(path: Path) -> None:
    """Refuse anything that is not a mesh before it is read: devices, folders, other files.

    Raises:
        MeshFileError: it is not a mesh; the message says why.
    """
    suffix = path.suffix.lower()
    if suffix not in (STL_SUFFIX, OBJ_SUFFIX, *SCENE_SUFFIXES):
        raise MeshFileError(
            f"'{suffix}' is not one of {', '.join((STL_SUFFIX, OBJ_SUFFIX, *SCENE_SUFFIXES))}"
        )
    try:
        check_file(path, LARGEST_BYTES)
    except (OSError, ValueError) as error:
        raise MeshFileError(str(error)) from error
    if suffix == PACKED_SUFFIX:
        from arm_description.mesh.packed import unpacked_bytes

        if (size := unpacked_bytes(path)) > LARGEST_BYTES:
            raise MeshFileError(f"it unpacks to {size} bytes; at most {LARGEST_BYTES} are read")


def read_mesh_file(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of a file that `check_mesh_file` allows, in m, one for each material.

    Raises:
        MeshFileError: the file is broken, or has no triangles.
    """
    if path.suffix.lower() == STL_SUFFIX:
        return (_read_stl(read_bytes(path, LARGEST_BYTES)),)
    parts = read_obj(path) if path.suffix.lower() == OBJ_SUFFIX else read_scene(path)
    if not parts:
        raise MeshFileError("no triangles in it")
    return parts


HEADER_BYTES = 80
TRIANGLE = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def _read_stl(data: bytes) -> MeshData:
    """Return the mesh of an STL file's bytes.

    Raises:
        MeshFileError: the bytes are not STL, or incomplete.
    """
    start = HEADER_BYTES + 4
    if len(data) >= start:
        count = int.from_bytes(data[HEADER_BYTES:start], "little")
        # A binary file may also start with the word 'solid', so the size decides.
        if count and len(data) >= start + count * TRIANGLE.itemsize:
            triangles = np.frombuffer(data, TRIANGLE, count, start)
            return merged(triangles["vertices"].reshape(-1, 3))
    if not data.lstrip()[:5].lower() == b"solid":
        raise MeshFileError("neither a text STL nor a complete binary one")
    return _read_text_stl(data)


def _read_text_stl(data: bytes) -> MeshData:
    corners = VERTEX.findall(data)
    if not corners or len(corners) % 3:
        raise MeshFileError(
            f"a text STL whose number of vertices, {len(corners)}, is not a multiple of 3"
        )
    try:
        return merged(np.array(corners).astype(np.float32))
    except ValueError as error:
        raise MeshFileError(f"a text STL with an invalid coordinate: {error}") from error
