"""Checks a 3MF file before trimesh reads it: its unit, its size, and how much it draws."""

import struct
import zipfile
import zlib
from pathlib import Path
from typing import IO

import lxml.etree as etree

from arm_description.errors import MeshFileError
from arm_description.mesh.collada import MAX_TEXT
from arm_description.mesh.data import LARGEST_BYTES
from arm_description.mesh.scene_graph import SceneNode, check_scene
from arm_node.user_file import read_bytes

MODEL = "3d/3dmodel.model"
UNITS_M = {
    **{"micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "meter": 1.0},
    **{"inch": 0.0254, "foot": 0.3048},
}
"""Length of the units that the format knows, in m."""
DEFAULT_UNIT = "millimeter"
EXTERNAL = SceneNode(1, ())
BROKEN = (
    *(zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError),
    *(LookupError, struct.error, etree.LxmlError),
)
"""Exceptions of zipfile and lxml for broken, encrypted and unknown content.

RuntimeError includes NotImplementedError, for unknown compression methods and ZIP versions.
"""


def unpacked_bytes(path: Path) -> int:
    """Return the unpacked size of a ZIP file, which may be a thousand times its own size.

    Raises:
        MeshFileError: it is not a ZIP file, or of an unknown kind.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return sum(entry.file_size for entry in archive.infolist())
    except BROKEN as error:
        raise MeshFileError(f"it is not a ZIP file, as 3MF files are: {error}") from error


def read_packed(path: Path) -> tuple[bytes, float]:
    """Return the content of a .3mf file, and the length of its unit in m, which trimesh ignores.

    Raises:
        MeshFileError: it is not 3MF, its unit is unknown, or it takes too much time or memory.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            name = next((n for n in archive.namelist() if MODEL in n.lower()), None)
            if name is None:
                raise MeshFileError(f"it is not 3MF: it does not contain {MODEL}")
            is_large = archive.getinfo(name).file_size > MAX_TEXT
            with archive.open(name) as model:
                objects, items, unit = _read(model, is_large)
    except BROKEN as error:
        raise MeshFileError(f"it is not 3MF: {error}") from error
    # Objects that are not in the model are in other files of the archive, one mesh each.
    check_scene(items, lambda name: objects.get(name, EXTERNAL))
    if unit not in UNITS_M:
        raise MeshFileError(f"its unit '{unit}' is not one of {', '.join(UNITS_M)}")
    return read_bytes(path, LARGEST_BYTES), UNITS_M[unit]


def _read(model: IO[bytes], is_large: bool) -> tuple[dict[str, SceneNode], list[str], str]:
    """Return the objects by id, the ids of those that are built, and the name of the unit."""
    objects: dict[str, SceneNode] = {}
    items: list[str] = []
    elements = etree.iterparse(
        model,
        events=("end",),
        tag=("{*}object", "{*}item"),
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=is_large,
    )
    for _, element in elements:
        if etree.QName(element).localname == "item":
            items.append(element.get("objectid", ""))
            continue
        triangles = sum(1 for _ in element.iter("{*}triangle"))
        used = tuple(part.get("objectid", "") for part in element.iter("{*}component"))
        meshes = sum(1 for _ in element.iter("{*}mesh"))
        objects[element.get("id", "")] = SceneNode(meshes, used, 3 * triangles)
        element.clear()
    return objects, items, elements.root.get("unit", DEFAULT_UNIT)
