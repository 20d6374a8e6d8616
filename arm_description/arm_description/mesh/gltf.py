"""Checks a glTF file before trimesh reads it: how much it draws, and which files it names."""

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast
from urllib.parse import unquote

from arm_description.errors import MeshFileError
from arm_description.mesh.data import LARGEST_BYTES
from arm_description.mesh.scene_graph import SceneNode, check_scene
from arm_node.user_file import check_file, read_bytes

BINARY_MAGIC = b"glTF"
BINARY_HEADER = struct.Struct("<4sIII4s")
"""Magic, version, total length; length and type of the first chunk, which is the JSON."""
MAX_ZEROS = 10_000_000
"""Maximum elements without data: a few digits in the file can stand for that many zeros."""


def check_gltf(path: Path) -> None:
    """Refuse a .gltf or .glb file that is not glTF, or that takes too much time or memory.

    Raises:
        MeshFileError: the file is refused.
    """
    document = _read(path)
    meshes = [list(_mappings(mesh, "primitives")) for mesh in _mappings(document, "meshes")]
    counts = [_count(accessor) for accessor in _mappings(document, "accessors")]
    nodes = list(_mappings(document, "nodes"))

    def find(name: str) -> SceneNode | None:
        node = nodes[int(name)] if name.isdecimal() and int(name) < len(nodes) else None
        if node is None:
            return None
        mesh = node.get("mesh")
        known = isinstance(mesh, int) and 0 <= mesh < len(meshes)
        primitives = meshes[cast("int", mesh)] if known else []
        corners = sum(_corners(primitive, counts) for primitive in primitives)
        return SceneNode(len(primitives), tuple(map(str, _entries(node, "children"))), corners)

    roots = [str(n) for scene in _mappings(document, "scenes") for n in _entries(scene, "nodes")]
    check_scene(roots, find)
    zeros = sum(_count(a) for a in _mappings(document, "accessors") if "bufferView" not in a)
    if zeros > MAX_ZEROS:
        raise MeshFileError(
            f"{zeros} of its elements have no data; at most {MAX_ZEROS} are allowed"
        )
    for part in ("buffers", "images"):
        for entry in _mappings(document, part):
            _check_uri(path, entry.get("uri"))


def _read(path: Path) -> Mapping[str, Any]:
    content = read_bytes(path, LARGEST_BYTES)
    if content.startswith(BINARY_MAGIC) and len(content) >= BINARY_HEADER.size:
        *_, length, _kind = BINARY_HEADER.unpack_from(content)
        content = content[BINARY_HEADER.size : BINARY_HEADER.size + length]
    try:
        document = json.loads(content)
    except RecursionError as error:
        raise MeshFileError("it is not glTF: its JSON is nested too deep") from error
    except ValueError as error:
        raise MeshFileError(f"it is not glTF: {error}") from error
    if not isinstance(document, dict):
        raise MeshFileError("it is not glTF: its JSON is not an object")
    return cast("Mapping[str, Any]", document)


def _count(accessor: Mapping[str, Any]) -> int:
    count = accessor.get("count")
    return max(0, count) if isinstance(count, int) else 0


def _corners(primitive: Mapping[str, Any], counts: Sequence[int]) -> int:
    """Return the number of corners of a primitive's triangles."""
    attributes = primitive.get("attributes")
    positions = attributes.get("POSITION") if isinstance(attributes, dict) else None
    used = (primitive.get("indices"), positions)
    return sum(counts[n] for n in used if isinstance(n, int) and 0 <= n < len(counts))


def _check_uri(path: Path, uri: object) -> None:
    """Refuse devices and the like; trimesh reports a missing file."""
    if isinstance(uri, str) and not uri.startswith("data:"):
        try:
            check_file(path.parent / unquote(uri), LARGEST_BYTES)
        except FileNotFoundError:
            return
        except (OSError, ValueError) as error:
            raise MeshFileError(f"it names {uri[:100]!r}: {error}") from error


def _entries(mapping: Mapping[str, Any], key: str) -> list[Any]:
    value = mapping.get(key)
    return cast("list[Any]", value) if isinstance(value, list) else []


def _mappings(document: Mapping[str, Any], key: str) -> Iterator[Mapping[str, Any]]:
    """Yield the objects of a list, and an empty one for any other entry."""
    for entry in _entries(document, key):
        yield cast("Mapping[str, Any]", entry) if isinstance(entry, dict) else {}
