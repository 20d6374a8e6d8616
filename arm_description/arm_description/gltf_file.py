"""What of a glTF file must be known before trimesh reads it: how much it draws, what it names."""

import json
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, cast
from urllib.parse import unquote

from arm_description.errors import MeshFileError
from arm_description.scene_graph import SceneNode, check_scene

BINARY_MAGIC = b"glTF"
BINARY_HEADER = struct.Struct("<4sIII4s")
"""Magic, version, length of all; length and type of the first chunk, which is the JSON."""
MOST_ZEROS = 10_000_000
"""Elements without data in the file: they stand for zeros, at the price of some digits."""


def check_gltf(path: Path) -> None:
    """Refuse a .gltf or .glb file that is no glTF, or that takes all time or memory.

    Raises:
        MeshFileError: it is one of these.
    """
    document = _read(path)
    meshes = [_entries(mesh, "primitives") for mesh in _mappings(document, "meshes")]
    nodes = list(_mappings(document, "nodes"))

    def find(name: str) -> SceneNode | None:
        node = nodes[int(name)] if name.isdecimal() and int(name) < len(nodes) else None
        if node is None:
            return None
        mesh = node.get("mesh")
        known = isinstance(mesh, int) and 0 <= mesh < len(meshes)
        geometries = len(meshes[cast("int", mesh)]) if known else 0
        return SceneNode(geometries, tuple(map(str, _entries(node, "children"))))

    roots = [str(n) for scene in _mappings(document, "scenes") for n in _entries(scene, "nodes")]
    check_scene(roots, find)
    empty = [a for a in _mappings(document, "accessors") if "bufferView" not in a]
    zeros = sum(count for a in empty if isinstance(count := a.get("count"), int))
    if zeros > MOST_ZEROS:
        raise MeshFileError(
            f"{zeros} of its elements are without data; at most {MOST_ZEROS} may be"
        )
    for part in ("buffers", "images"):
        for entry in _mappings(document, part):
            _check_uri(path, entry.get("uri"))


def _read(path: Path) -> Mapping[str, Any]:
    content = path.read_bytes()
    if content.startswith(BINARY_MAGIC) and len(content) >= BINARY_HEADER.size:
        *_, length, _kind = BINARY_HEADER.unpack_from(content)
        content = content[BINARY_HEADER.size : BINARY_HEADER.size + length]
    try:
        document = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise MeshFileError(f"no glTF: {error}") from error
    if not isinstance(document, dict):
        raise MeshFileError("no glTF: its JSON is not an object")
    return cast("Mapping[str, Any]", document)


def _check_uri(path: Path, uri: object) -> None:
    """Refuse devices and the like; a file that is missing is trimesh's to tell."""
    if isinstance(uri, str) and not uri.startswith("data:"):
        named = path.parent / unquote(uri)
        try:
            unreadable = named.exists() and not named.is_file()
        except (OSError, ValueError) as error:
            raise MeshFileError(f"it names the file {uri[:100]!r}: {error}") from error
        if unreadable:
            raise MeshFileError(f"it names {uri[:100]!r}, which is no file")


def _entries(mapping: Mapping[str, Any], key: str) -> list[Any]:
    value = mapping.get(key)
    return cast("list[Any]", value) if isinstance(value, list) else []


def _mappings(document: Mapping[str, Any], key: str) -> Iterator[Mapping[str, Any]]:
    """Yield the objects of a list, an empty one for whatever else is in it."""
    for entry in _entries(document, key):
        yield cast("Mapping[str, Any]", entry) if isinstance(entry, dict) else {}
