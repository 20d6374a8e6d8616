"""Mesh files with parts and colours: .obj .dae .glb .gltf .ply .off .3mf, read by trimesh."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from arm_description.errors import MeshFileError
from arm_description.mesh_data import Color, MeshData

COLLADA_UNIT = re.compile(rb"<unit\b[^>]*\bmeter\s*=\s*[\"']([^\"']+)[\"']")
COLLADA_HEAD_BYTES = 65536


def read_scene(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of a mesh file in m, one for each material.

    Raises:
        MeshFileError: trimesh cannot read the file, or it holds no triangles.
    """
    # trimesh takes half a second to import; a robot of STL files does without.
    import trimesh

    try:
        scene = trimesh.load_scene(str(path), process=False, group_material=True)
        meshes = [mesh for mesh in scene.dump() if isinstance(mesh, trimesh.Trimesh)]
    except Exception as error:
        # Each of trimesh's loaders raises types of its own, for a broken file any of them.
        raise MeshFileError(f"{type(error).__name__}: {error}") from error
    unit = _collada_unit(path)
    parts = tuple(_part(mesh, unit) for mesh in meshes if len(mesh.faces))
    if not parts:
        raise MeshFileError("no triangles in it")
    return parts


def _part(mesh: Any, unit: float) -> MeshData:
    vertices = np.asarray(mesh.vertices, dtype=np.float64) * unit
    return MeshData(vertices, np.asarray(mesh.faces, dtype=np.int32), _color(mesh.visual))


def _color(visual: Any) -> Color | None:
    material = getattr(visual, "material", None)
    if material is not None:
        rgba = np.asarray(material.main_color, dtype=np.float64) / 255
    elif getattr(visual, "defined", False):
        rgba = np.asarray(visual.main_color, dtype=np.float64) / 255
    else:
        return None
    return (float(rgba[0]), float(rgba[1]), float(rgba[2]), float(rgba[3]))


def _collada_unit(path: Path) -> float:
    """Return how many metres one unit of the file is: trimesh ignores what COLLADA says."""
    if path.suffix.lower() != ".dae":
        return 1.0
    with path.open("rb") as file:
        found = COLLADA_UNIT.search(file.read(COLLADA_HEAD_BYTES))
    try:
        unit = float(found.group(1)) if found else 1.0
    except ValueError as error:
        raise MeshFileError(f"its <unit> is no number: {error}") from error
    if not (np.isfinite(unit) and unit > 0):
        raise MeshFileError(f"its <unit> of {unit:g} m is not above 0")
    return unit
