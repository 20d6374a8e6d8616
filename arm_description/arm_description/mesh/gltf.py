"""Checks a glTF file before trimesh reads it, and says in trimesh's words what trimesh overlooks.

trimesh takes normalised positions for plain integers, 32,767 times too large, and the opacity of
materials that are declared opaque.
"""

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


TRIANGLE_FAN = 6
LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
"""The integer that stands for 1 in a normalised accessor, by glTF's number of its type."""
COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")


def read_gltf(path: Path) -> bytes:
    """Return the content of a .gltf or .glb file as trimesh reads it rightly.

    Raises:
        MeshFileError: it is not glTF, is compressed, or takes too much time or memory.
    """
    content = read_bytes(path, LARGEST_BYTES)
    document = _document(content)
    _check(path, document)
    changed = _scale_normalised(document)
    changed |= _settle_opacity(document)
    return _rewritten(content, document) if changed else content


def _check(path: Path, document: Mapping[str, Any]) -> None:
    required = _entries(document, "extensionsRequired")
    for extension in COMPRESSIONS:
        if extension in required:
            raise MeshFileError(f"it is compressed ({extension}); export it without compression")
    _check_forms(document)
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


def _check_forms(document: Mapping[str, Any]) -> None:
    """Refuse the valid forms that trimesh leaves out, or reads without what they replace."""
    accessors = list(_mappings(document, "accessors"))
    for mesh in _mappings(document, "meshes"):
        for primitive in _mappings(mesh, "primitives"):
            if primitive.get("mode") == TRIANGLE_FAN:
                raise MeshFileError("it has triangle fans; export it with triangles")
            used = _used(primitive)
            if any("sparse" in accessors[n] for n in used if n < len(accessors)):
                raise MeshFileError("it has sparse accessors; export it without them")


def _document(content: bytes) -> dict[str, Any]:
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
    return cast("dict[str, Any]", document)


def _rewritten(content: bytes, document: Mapping[str, Any]) -> bytes:
    """Return the file with another document; in a binary one the rest stays as it is."""
    text = json.dumps(document).encode()
    if not content.startswith(BINARY_MAGIC):
        return text
    text += b" " * (-len(text) % 4)
    magic, version, _, length, kind = BINARY_HEADER.unpack_from(content)
    rest = content[BINARY_HEADER.size + length :]
    total = BINARY_HEADER.size + len(text) + len(rest)
    return BINARY_HEADER.pack(magic, version, total, len(text), kind) + text + rest


def _scale_normalised(document: dict[str, Any]) -> bool:
    """Put what has normalised positions below a node that scales it; return whether any had."""
    accessors = list(_mappings(document, "accessors"))
    meshes, nodes = _entries(document, "meshes"), _entries(document, "nodes")
    for node in [node for node in nodes if isinstance(node, dict)]:
        number = node.get("mesh")
        if not (isinstance(number, int) and 0 <= number < len(meshes)):
            continue
        by_scale: dict[float, list[Any]] = {}
        for primitive in _mappings(cast("Mapping[str, Any]", meshes[number]), "primitives"):
            by_scale.setdefault(_scale(primitive, accessors), []).append(primitive)
        if by_scale.keys() <= {1.0}:
            continue
        del node["mesh"]
        for scale, primitives in by_scale.items():
            node["children"] = [*_entries(node, "children"), len(nodes)]
            nodes.append({"mesh": len(meshes), "scale": [scale] * 3})
            meshes.append({"primitives": primitives})
    return any(_scale(p, accessors) != 1.0 for m in meshes for p in _mappings(m, "primitives"))


def _scale(primitive: Mapping[str, Any], accessors: Sequence[Mapping[str, Any]]) -> float:
    """Return what the positions of a primitive, read as plain numbers, must be multiplied by."""
    attributes = primitive.get("attributes")
    number = attributes.get("POSITION") if isinstance(attributes, dict) else None
    if not (isinstance(number, int) and 0 <= number < len(accessors)):
        return 1.0
    accessor = accessors[number]
    if accessor.get("normalized") is not True:
        return 1.0
    return 1.0 / LARGEST.get(cast("int", accessor.get("componentType")), 1)


def _settle_opacity(document: Mapping[str, Any]) -> bool:
    """Write the opacity that a material's alpha mode gives into its colour; return if any changed.

    By default a material is opaque, whatever its colour says.
    """
    changed = False
    for material in _mappings(document, "materials"):
        look = material.get("pbrMetallicRoughness")
        color = look.get("baseColorFactor") if isinstance(look, dict) else None
        if not (isinstance(color, list) and len(color) == 4 and _is_number(color[3])):
            continue
        mode = material.get("alphaMode", "OPAQUE")
        cutoff = material.get("alphaCutoff", 0.5)
        if mode == "MASK" and _is_number(cutoff):
            alpha = float(color[3] >= cutoff)
        else:
            alpha = color[3] if mode == "BLEND" else 1.0
        changed |= alpha != color[3]
        color[3] = alpha
    return changed


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)


def _count(accessor: Mapping[str, Any]) -> int:
    count = accessor.get("count")
    return max(0, count) if isinstance(count, int) else 0


def _corners(primitive: Mapping[str, Any], counts: Sequence[int]) -> int:
    """Return the number of corners of a primitive's triangles."""
    return sum(counts[n] for n in _used(primitive) if n < len(counts))


def _used(primitive: Mapping[str, Any]) -> list[int]:
    """Return the accessors of a primitive's positions and indices."""
    attributes = primitive.get("attributes")
    positions = attributes.get("POSITION") if isinstance(attributes, dict) else None
    return [n for n in (primitive.get("indices"), positions) if isinstance(n, int) and n >= 0]


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
