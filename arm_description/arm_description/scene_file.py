"""Mesh files with parts and colours: .obj .dae .glb .gltf .ply .off .3mf, read by trimesh."""

from pathlib import Path
from typing import Any

import numpy as np

from arm_description.collada_file import read_collada_unit
from arm_description.errors import MeshFileError
from arm_description.gltf_file import check_gltf
from arm_description.mesh_data import Color, MeshData
from arm_description.packed_file import check_packed

COLLADA_SUFFIX = ".dae"
CHECKS = {".gltf": check_gltf, ".glb": check_gltf, ".3mf": check_packed}
"""What must hold before trimesh reads a file."""


def read_scene(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of a mesh file in m, one for each material.

    Raises:
        MeshFileError: trimesh cannot read the file, it would draw more than anybody can, or it
            holds no triangles.
    """
    suffix = path.suffix.lower()
    unit = read_collada_unit(path) if suffix == COLLADA_SUFFIX else 1.0
    if suffix in CHECKS:
        CHECKS[suffix](path)
    # trimesh takes half a second to import; a robot of STL files does without.
    import trimesh

    try:
        scene = trimesh.load_scene(str(path), process=False, group_material=True)
        meshes = [mesh for mesh in scene.dump() if isinstance(mesh, trimesh.Trimesh)]
    except Exception as error:
        # Each of trimesh's loaders raises types of its own, for a broken file any of them.
        raise MeshFileError(f"{type(error).__name__}: {error}") from error
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
