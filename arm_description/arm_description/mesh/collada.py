"""Checks a COLLADA file before trimesh reads it, and rewrites what trimesh would read wrongly.

It checks the unit, and how much the file draws. pycollada cuts an array into rows without the
accessor's offset and stride, fills the notches of polygons, and trimesh takes one number of
<transparent> for the opacity: such valid forms are rewritten.
"""

import io
from collections.abc import Iterator, Mapping
from pathlib import Path

import lxml.etree as etree
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import LARGEST_BYTES, numbers_in
from arm_description.mesh.polygons import triangulated
from arm_description.mesh.scene_graph import SceneNode, check_scene
from arm_node.user_file import read_bytes

MAX_TEXT = 10_000_000
"""Bytes that libxml2 accepts in one element, unless told to accept any size."""


def read_collada(path: Path) -> tuple[bytes, float]:
    """Return the content of a file as trimesh reads it rightly, and the length of its unit in m.

    trimesh ignores COLLADA's <unit>.

    Raises:
        MeshFileError: the file is not XML, or has a DOCTYPE, an invalid unit, broken numbers, or
            nodes that use each other without bound.
    """
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=path.stat().st_size > MAX_TEXT,
    )
    try:
        content = read_bytes(path, LARGEST_BYTES)
        document = etree.parse(io.BytesIO(content), parser)
    except etree.XMLSyntaxError as error:
        raise MeshFileError(f"it is not XML: {error.msg}") from error
    if document.docinfo.internalDTD is not None:
        raise MeshFileError("it has a DOCTYPE, which is not accepted; remove it")
    root = document.getroot()
    _check_instances(root)
    unit = _unit(root)
    return (etree.tostring(root) if rewrite(root) else content), unit


def _unit(root: etree._Element) -> float:
    text = next((unit.get("meter") for unit in root.iterfind("{*}asset/{*}unit")), None)
    try:
        unit = 1.0 if text is None else float(text)
    except ValueError as error:
        raise MeshFileError(f"its <unit> is not a number: {error}") from error
    if not (np.isfinite(unit) and unit > 0):
        raise MeshFileError(f"its <unit> of {unit:g} m is not above 0")
    return unit


def _check_instances(root: etree._Element) -> None:
    nodes = {f"#{node.get('id')}": node for node in root.iter("{*}node") if node.get("id")}
    corners = {f"#{g.get('id')}": _corners(g) for g in root.iter("{*}geometry")}
    scenes = {f"scene {n}": scene for n, scene in enumerate(root.iter("{*}visual_scene"))}

    def find(name: str) -> SceneNode | None:
        element = scenes[name] if name in scenes else nodes.get(name)
        return None if element is None else _scene_node(element, corners)

    check_scene(scenes, find)


def _scene_node(element: etree._Element, corners: Mapping[str, int]) -> SceneNode:
    """Return what an element and the elements within it use."""
    drawn = list(element.iter("{*}instance_geometry", "{*}instance_controller"))
    return SceneNode(
        len(drawn),
        tuple(used.get("url", "") for used in element.iter("{*}instance_node")),
        sum(corners.get(geometry.get("url", ""), 0) for geometry in drawn),
    )


def _corners(geometry: etree._Element) -> int:
    """Estimate how many corners a geometry's faces have: one digit and one blank each."""
    return sum(len(indices.text or "") for indices in geometry.iter("{*}p")) // 2


LUMINANCE = (0.212671, 0.715160, 0.072169)
"""Weights of red, green and blue, as COLLADA gives them for <transparent>."""
Numbers = NDArray[np.float64]
Rows = NDArray[np.int64]


def rewrite(root: etree._Element) -> bool:
    """Rewrite a document in place; return whether it needed it.

    Raises:
        MeshFileError: numbers or references are broken, or a face has holes.
    """
    meshes = list(root.iter("{*}mesh"))
    points = {id(mesh): _points(mesh) for mesh in meshes}
    changed = [_compact_sources(mesh) for mesh in meshes]
    changed += [_cut_polygons(mesh, points[id(mesh)]) for mesh in meshes]
    changed += [_settle_opacity(shading) for shading in root.iterfind(".//{*}technique/*")]
    return any(changed)


def _points(mesh: etree._Element) -> Numbers:
    """Return the positions of a mesh's vertices, shape (v, 3); (0, 3) if there are none."""
    source = mesh.find("{*}vertices/{*}input[@semantic='POSITION']")
    names = {f"#{each.get('id')}": each for each in mesh.iterfind("{*}source")}
    found = None if source is None else names.get(source.get("source", ""))
    table = None if found is None else _table(mesh, found)
    return np.empty((0, 3)) if table is None or table.shape[1] < 3 else table[:, :3]


def _table(mesh: etree._Element, source: etree._Element) -> Numbers | None:
    """Return the rows of a source as its accessor says, shape (count, named parameters)."""
    accessor = source.find("{*}technique_common/{*}accessor")
    if accessor is None:
        return None
    arrays = {f"#{each.get('id')}": each for each in mesh.iter("{*}float_array")}
    array = arrays.get(accessor.get("source", ""))
    named = [k for k, p in enumerate(accessor.iterfind("{*}param")) if p.get("name")]
    if array is None or not named:
        return None
    values = numbers_in(array.text or "", "a coordinate", np.float64)
    count, offset, stride = (
        _whole(accessor, key, default)
        for key, default in (("count", 0), ("offset", 0), ("stride", 1))
    )
    if count and offset + stride * (count - 1) + named[-1] >= len(values):
        raise MeshFileError(f"its array {array.get('id')!r} is too short for its accessor")
    return values[offset + stride * np.arange(count)[:, None] + named]


def _compact_sources(mesh: etree._Element) -> bool:
    """Write the arrays row by row where an accessor leaves anything out."""
    sources = [source for source in mesh.iterfind("{*}source") if not _is_plain(source)]
    # All are read before any is written: several may share an array.
    tables = [_table(mesh, source) for source in sources]
    for source, table in zip(sources, tables, strict=True):
        accessor = source.find("{*}technique_common/{*}accessor")
        if table is None or accessor is None:
            continue
        for parameter in [p for p in accessor.iterfind("{*}param") if not p.get("name")]:
            accessor.remove(parameter)
        for array in source.findall("{*}float_array"):
            source.remove(array)
        name = f"{source.get('id')}-rows"
        array = etree.Element(_tag(accessor, "float_array"), id=name)
        array.set("count", str(table.size))
        array.text = " ".join(map(repr, table.ravel().tolist()))
        source.insert(0, array)
        accessor.attrib.pop("offset", None)
        accessor.set("stride", str(table.shape[1]))
        accessor.set("source", f"#{name}")
    return bool(sources)


def _is_plain(source: etree._Element) -> bool:
    """Return whether pycollada reads a source rightly: its whole array, row by row."""
    accessor = source.find("{*}technique_common/{*}accessor")
    array = source.find("{*}float_array")
    if accessor is None or source.find("{*}Name_array") is not None:
        return True
    parameters = list(accessor.iterfind("{*}param"))
    return (
        array is not None
        and accessor.get("source") == f"#{array.get('id')}"
        and _whole(accessor, "offset", 0) == 0
        and _whole(accessor, "stride", 1) == len(parameters)
        and all(parameter.get("name") for parameter in parameters)
    )


def _cut_polygons(mesh: etree._Element, points: Numbers) -> bool:
    """Write faces that are not triangles as triangles; return whether there were any."""
    changed = False
    for kind in ("polylist", "polygons", "trifans", "tristrips"):
        for faces in mesh.findall(f"{{*}}{kind}"):
            changed |= _cut(kind, faces, points)
    return changed


def _cut(kind: str, faces: etree._Element, points: Numbers) -> bool:
    inputs = faces.findall("{*}input")
    width = 1 + max((_whole(each, "offset", 0) for each in inputs), default=0)
    vertex = next((i for i in inputs if i.get("semantic") == "VERTEX"), None)
    if vertex is None or not len(points):
        return False
    if faces.find("{*}ph") is not None:
        raise MeshFileError("a face has holes; export it with triangles")
    rows, counts = _rows(kind, faces, width)
    at = rows[:, _whole(vertex, "offset", 0)]
    if len(at) and (at.min() < 0 or at.max() >= len(points)):
        raise MeshFileError("a triangle has a vertex that does not exist")
    if kind in ("polylist", "polygons"):
        if (counts <= 3).all():
            return False
        triangles, _ = triangulated(points[at], np.arange(len(at)), counts)
    else:
        triangles = np.array(list(_strung(kind, counts)), dtype=np.int64).reshape(-1, 3)
    for child in list(faces.iterchildren("{*}vcount", "{*}p")):
        faces.remove(child)
    faces.tag = _tag(faces, "triangles")
    faces.set("count", str(len(triangles)))
    corners = etree.SubElement(faces, _tag(faces, "p"))
    corners.text = " ".join(map(str, rows[triangles.ravel()].ravel().tolist()))
    return True


def _rows(kind: str, faces: etree._Element, width: int) -> tuple[Rows, Rows]:
    """Return the indices of each corner, shape (corners, width), and the corners of each face."""
    texts = [numbers_in(each.text or "", "an index", np.int64) for each in faces.iterfind("{*}p")]
    every = np.concatenate([np.empty(0, np.int64), *texts])
    if kind == "polylist":
        sizes = faces.find("{*}vcount")
        counts = numbers_in("" if sizes is None else sizes.text or "", "a count", np.int64)
    else:
        counts = np.array([len(text) // width for text in texts], dtype=np.int64)
    if len(every) != width * counts.sum() or (counts < 0).any():
        raise MeshFileError("its faces have another number of corners than they say")
    return every.reshape(-1, width), counts


def _strung(kind: str, counts: Rows) -> Iterator[tuple[int, int, int]]:
    """Yield the corners of the triangles of strips and fans."""
    start = 0
    for count in counts.tolist():
        for k in range(start + 1, start + count - 1):
            if kind == "trifans":
                yield start, k, k + 1
            else:
                # Every second triangle of a strip turns the other way.
                yield (k - 1, k, k + 1) if (k - start) % 2 else (k, k - 1, k + 1)
        start += count


def _settle_opacity(shading: etree._Element) -> bool:
    """Write the opacity of a material where trimesh looks for it; return whether it has one."""
    transparent, amount = shading.find("{*}transparent"), shading.find("{*}transparency/{*}float")
    color = None if transparent is None else transparent.find("{*}color")
    if (amount is None and color is None) or (transparent is not None and color is None):
        return False
    strength = 1.0 if amount is None else _number(amount.text)
    rgba = np.ones(4) if color is None else numbers_in(color.text or "", "a colour", np.float64)
    if len(rgba) != 4:
        return False
    mode = "A_ONE" if transparent is None else transparent.get("opaque", "A_ONE")
    share = rgba[3] if mode.startswith("A_") else rgba[:3] @ LUMINANCE
    opacity = 1.0 - share * strength if mode.endswith("_ZERO") else share * strength
    for child in list(shading.iterchildren("{*}transparent", "{*}transparency")):
        shading.remove(child)
    settled = etree.SubElement(shading, _tag(shading, "transparent"), opaque="A_ONE")
    wanted = etree.SubElement(settled, _tag(shading, "color"))
    wanted.text = f"1 1 1 {min(max(float(opacity), 0.0), 1.0)!r}"
    return True


def _tag(near: etree._Element, name: str) -> str:
    """Return the tag of a new element in the namespace of another one."""
    space = etree.QName(near).namespace
    return f"{{{space}}}{name}" if space else name


def _number(text: str | None) -> float:
    try:
        return float(text or "")
    except ValueError as error:
        raise MeshFileError(f"a number is broken: {error}") from error


def _whole(element: etree._Element, key: str, default: int) -> int:
    text = element.get(key, str(default))
    if not text.strip().isdecimal():
        raise MeshFileError(f"{key}={text[:100]!r} is not a whole number of 0 or more")
    return int(text)
