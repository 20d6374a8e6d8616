"""Mesh files of every kind that a description may name."""

from pathlib import Path

from arm_description.errors import MeshFileError
from arm_description.mesh_data import MeshData
from arm_description.scene_file import read_scene
from arm_description.stl_file import read_stl

STL_SUFFIX = ".stl"
PACKED_SUFFIX = ".3mf"
SCENE_SUFFIXES = (".obj", ".dae", ".glb", ".gltf", ".ply", ".off", PACKED_SUFFIX)
LARGEST_BYTES = 500_000_000


def check_mesh_file(path: Path) -> None:
    """Refuse what is no mesh before it is read: devices, folders, files of other kinds.

    Raises:
        MeshFileError: it is one of these; the message says which.
    """
    suffix = path.suffix.lower()
    if suffix not in (STL_SUFFIX, *SCENE_SUFFIXES):
        raise MeshFileError(f"'{suffix}' is not one of {STL_SUFFIX}, {', '.join(SCENE_SUFFIXES)}")
    if not path.is_file():
        raise MeshFileError("it is no file")
    size = _packed_bytes(path) if suffix == PACKED_SUFFIX else path.stat().st_size
    if size > LARGEST_BYTES:
        raise MeshFileError(f"it has {size} bytes; at most {LARGEST_BYTES} are read")


def read_mesh_file(path: Path) -> tuple[MeshData, ...]:
    """Return the parts of a file that `check_mesh_file` allows, in m, one for each material.

    Raises:
        MeshFileError: the file is broken, or holds no triangles.
    """
    if path.suffix.lower() == STL_SUFFIX:
        return (read_stl(path.read_bytes()),)
    return read_scene(path)


def _packed_bytes(path: Path) -> int:
    # A robot of other meshes does without zipfile and lxml.
    from arm_description.packed_file import unpacked_bytes

    return unpacked_bytes(path)
