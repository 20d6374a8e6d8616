"""What of a 3MF file must be known before trimesh reads it: how large it is, how much it draws."""

import zipfile
import zlib
from pathlib import Path
from typing import IO

import lxml.etree as etree

from arm_description.errors import MeshFileError
from arm_description.scene_graph import SceneNode, check_scene

MODEL = "3d/3dmodel.model"
LONGEST_TEXT = 10_000_000
"""What libxml2 takes in one element, in bytes, unless it is told to take anything."""
ELSEWHERE = SceneNode(1, ())
BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError, etree.LxmlError)
"""What zipfile and lxml raise for broken, encrypted and unknown content.

RuntimeError stands for NotImplementedError, too: of packing methods and ZIP versions to come.
"""


def unpacked_bytes(path: Path) -> int:
    """Return how large the content of a ZIP file is: a thousand times its size, if it is a trap.

    Raises:
        MeshFileError: it is no ZIP file, or one of a kind unknown here.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return sum(entry.file_size for entry in archive.infolist())
    except BROKEN as error:
        raise MeshFileError(f"it is no ZIP file, as 3MF files are: {error}") from error


def check_packed(path: Path) -> None:
    """Refuse a .3mf file that is none, or that takes all time or memory.

    Raises:
        MeshFileError: it is one of these.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            name = next((n for n in archive.namelist() if MODEL in n.lower()), None)
            if name is None:
                raise MeshFileError(f"no 3MF: there is no {MODEL} in it")
            is_large = archive.getinfo(name).file_size > LONGEST_TEXT
            with archive.open(name) as model:
                objects, items = _read(model, is_large)
    except BROKEN as error:
        raise MeshFileError(f"no 3MF: {error}") from error
    # What is not in the model lies in other files of the archive, one mesh each.
    check_scene(items, lambda name: objects.get(name, ELSEWHERE))


def _read(model: IO[bytes], is_large: bool) -> tuple[dict[str, SceneNode], list[str]]:
    """Return the objects by id, and the ids of those that are built."""
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
        used = tuple(part.get("objectid", "") for part in element.iter("{*}component"))
        meshes = sum(1 for _ in element.iter("{*}mesh"))
        objects[element.get("id", "")] = SceneNode(meshes, used)
        element.clear()
    return objects, items
