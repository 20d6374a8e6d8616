"""Estimate the memory of an MJCF model from its text, before MuJoCo compiles it.

A line of 150 bytes can request gigabytes: a height field, a texture, a user sensor, or a body
that is replicated a hundred thousand times. The figures were measured with MuJoCo 4.0 and rounded
up.
"""

import re
import struct
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import lxml.etree as etree

from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.errors import ModelError
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.mjcf.references import FILES
from arm_node.frozen import frozen
from arm_node.user_file import open_file, read_text

MAX_COPIES = 5_000
"""Limit on replicated elements; MuJoCo's compile time grows with the square of their number."""
BYTES_PER_CELL = 20
BYTES_PER_PIXEL = 8
BYTES_PER_NUMBER = 8
BYTES_PER_FLEX_POINT = 4_000
BYTES_PER_BUILTIN_VERTEX = 2_000
"""The vertices of <mesh builtin="...">, with their normals, faces and hull."""
BYTES_PER_CONTACT = 150
BYTES_PER_ENTRY: Mapping[str, int] = {"nsample": 40, "actdim": 64}
"""Attributes of actuators and sensors that are lengths: of a history, of an activation."""
MOST = 10**15
"""Larger counts are taken for this one."""
CUBES = ("cube", "skybox")
SIZE = re.compile(r"\s*(\d{1,15})\s*([KMGTPE]?)\s*", re.IGNORECASE)
PNG = b"\x89PNG\r\n\x1a\n"
PNG_HEADER = struct.Struct(">8s8xII")


@frozen
class _Demand:
    label: str
    size: int


def check_mjcf_size(text: str, source: str, path: Path | None, limit: MemoryLimit) -> None:
    """Refuse an MJCF that requests more memory than the limit, or too many copies.

    Messages call it `source`; `path` is None if the text does not come from a file.

    Raises:
        ModelError: the limit is exceeded; the message names the largest element.
        XmlError: the MJCF, or a file that it includes, is not XML.
        OSError: an included file cannot be read.
    """
    root = parse_xml(text, source)
    folders = () if path is None else (path.parent,)
    walk = _MjcfWalk(folders, root)
    demands = list(walk.demands(root, 1))
    if walk.copies > MAX_COPIES:
        raise ModelError(
            f"{source}: its <replicate> elements make {walk.copies} copies; at most {MAX_COPIES} "
            "are compiled"
        )
    total = sum(demand.size for demand in demands)
    if total > limit.mb * 1e6:
        largest = max(demands, key=lambda demand: demand.size)
        raise ModelError(
            f"{source}: it needs about {total / 1e6:.0f} MB, most of it for {largest.label}; "
            f"at most {limit.mb:.0f} MB are allowed (parameter {limit.parameter})"
        )


class _MjcfWalk:
    """Walks an MJCF and the files that it includes, and counts replicated elements.

    Attributes:
        copies: number of replicated elements so far.
        elements: number of elements of the MJCF itself.
        pixels: pixel count of each of its cameras, by name.
    """

    def __init__(self, folders: tuple[Path, ...], root: etree._Element) -> None:
        self.copies = 0
        self.elements = sum(1 for _ in root.iter("*"))
        self.pixels = {c.get("name", ""): _resolution(c) for c in root.iter("camera")}
        self._folders = folders
        self._seen: set[Path] = set()
        self._assets: dict[str, tuple[Path, ...]] = {}
        compiler = root.find("compiler")
        assets = "" if compiler is None else compiler.get("assetdir", "")
        for kind in ("meshdir", "texturedir"):
            given = "" if compiler is None else compiler.get(kind, "")
            self._assets[kind] = tuple(folder / (given or assets) for folder in folders)

    def demands(self, element: etree._Element, times: int) -> Iterator[_Demand]:
        """Yield the memory that child elements need; their parents are copied `times` times."""
        for child in element.iterchildren("*"):
            tag = str(child.tag)
            inner = times
            if tag == "replicate":
                inner = min(times * max(1, _whole(child.get("count"))), MOST)
            elif inner > 1:
                self.copies += inner
            if tag in ("include", "model"):
                yield from self._included(child, inner)
            elif size := self._size(child, tag):
                yield _Demand(_label(child), size * inner)
            yield from self.demands(child, inner)

    def picture_size(self, file: str, folder: str) -> int:
        """Return the pixel count of a PNG file in `meshdir` or `texturedir`, 0 for another file.

        A PNG may unpack to a thousand times its size.
        """
        for place in self._assets[folder] if file else ():
            try:
                with open_file(place / file) as stream:
                    header = stream.read(PNG_HEADER.size)
            except (OSError, ValueError):
                continue
            if len(header) == PNG_HEADER.size and header.startswith(PNG):
                _, width, height = PNG_HEADER.unpack(header)
                return int(width * height)
        return 0

    def _size(self, element: etree._Element, tag: str) -> int:
        own = DEMANDS[tag](element, self) if tag in DEMANDS else 0
        return own + sum(
            _whole(element.get(key)) * size_bytes for key, size_bytes in BYTES_PER_ENTRY.items()
        )

    def _included(self, element: etree._Element, times: int) -> Iterator[_Demand]:
        for folder in self._folders:
            path = folder / element.get("file", "")
            # MuJoCo itself reports a missing file, and one that is included twice.
            if path.is_file() and path not in self._seen:
                self._seen.add(path)
                yield from self.demands(parse_xml(read_text(path), str(path)), times)


def _label(element: etree._Element) -> str:
    name = element.get("name", "")
    what = f"{element.tag} '{name}'" if name else f"<{element.tag}>"
    return f"{what} (line {element.sourceline})"


def _resolution(camera: etree._Element) -> int:
    width, height, *_rest = (*map(_whole, camera.get("resolution", "").split()), 1, 1)
    return width * height


def _hfield(element: etree._Element, walk: _MjcfWalk) -> int:
    cells = _whole(element.get("nrow")) * _whole(element.get("ncol"))
    return (cells or walk.picture_size(element.get("file", ""), "meshdir")) * BYTES_PER_CELL


def _texture(element: etree._Element, walk: _MjcfWalk) -> int:
    width = _whole(element.get("width"))
    height = width if element.get("type", "cube") in CUBES else _whole(element.get("height"))
    faces = 6 if element.get("type", "cube") in CUBES else 1
    files = [element.get(attribute, "") for attribute in FILES]
    pixels = sum(walk.picture_size(file, "texturedir") for file in files)
    return max(width * max(height, 1) * faces, pixels * faces) * BYTES_PER_PIXEL


def _builtin_mesh(element: etree._Element, _: _MjcfWalk) -> int:
    """Return the memory of a mesh of MuJoCo's own, whose resolution comes first in its params."""
    if not element.get("builtin"):
        return 0
    first, second, *_rest = (*map(_whole, element.get("params", "").split()), 0, 0)
    # A supersphere has one resolution for both directions, a plate two.
    return first * max(first, second) * BYTES_PER_BUILTIN_VERTEX


def _user_sensor(element: etree._Element, _: _MjcfWalk) -> int:
    return _whole(element.get("dim")) * BYTES_PER_NUMBER


def _contact_sensor(element: etree._Element, _: _MjcfWalk) -> int:
    # The <contact> of <mujoco>, which lists pairs of geoms, has no such attribute.
    return _whole(element.get("num")) * BYTES_PER_CONTACT


def _rangefinder(element: etree._Element, walk: _MjcfWalk) -> int:
    """Return the memory of a distance for each pixel of a camera; a site has one distance."""
    return walk.pixels.get(element.get("camera", ""), 1) * BYTES_PER_NUMBER


def _flex(element: etree._Element, _: _MjcfWalk) -> int:
    points = 1
    for key in ("count", "cellcount"):
        for word in element.get(key, "").split():
            points = min(points * max(1, _whole(word)), MOST)
    return points * BYTES_PER_FLEX_POINT


def _sizes(element: etree._Element, walk: _MjcfWalk) -> int:
    """Return the memory that <size> requests: the arena, and user data for each element."""
    memory = SIZE.fullmatch(element.get("memory", ""))
    arena = int(memory[1]) << 10 * (" KMGTPE".index(memory[2].upper() or " ")) if memory else 0
    numbers = sum(
        _whole(value) * (1 if key in ("nuserdata", "nstack") else walk.elements)
        for key, value in element.attrib.items()
        if str(key).startswith(("nuser", "nkey", "nstack", "njmax", "nconmax"))
    )
    return arena + numbers * BYTES_PER_NUMBER


DEMANDS: Mapping[str, Callable[[etree._Element, _MjcfWalk], int]] = {
    "hfield": _hfield,
    "texture": _texture,
    "mesh": _builtin_mesh,
    "user": _user_sensor,
    "contact": _contact_sensor,
    "rangefinder": _rangefinder,
    "flexcomp": _flex,
    "composite": _flex,
    "flex": _flex,
    "size": _sizes,
}


def _whole(text: str | None) -> int:
    """Return the text as a whole number, capped at MOST; 0 if it is not a number."""
    digits = (text or "").strip()
    try:
        return min(max(0, int(float(digits[:40]))), MOST)
    except (ValueError, OverflowError):
        return 0
