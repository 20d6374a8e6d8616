"""A cache of parsed meshes in the user's cache folder, keyed by the content of their files."""

import contextlib
import hashlib
import logging
import math
import os
import struct
import tempfile
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData
from arm_gazebo.mesh.part import MeshPart

logger = logging.getLogger(__name__)

VERSION = "5"
"""Part of every key. Raise it when the same file is parsed to a different result."""
MAX_CACHE_BYTES = 1_000_000_000
"""Limit on the size of all entries; the least recently used are deleted first."""
SUFFIXES = (".mesh", ".npz")
"""What names of entries end with; the second one is that of earlier versions."""

_CHECKSUM = struct.Struct("<I4x")
"""An entry begins with the CRC-32 of the rest of it, so that no damaged one is used. It is padded
so that the numbers after it are aligned.
"""
_SIZES = struct.Struct("<5q4d")
"""The start of a part: its numbers of vertices, faces and hull vertices, of triangles and different
ones; its colour, NaN for none. The arrays follow, without the hull if it is all vertices. NumPy's
own format takes ten times as long.
"""
_TYPES = (np.dtype("<f8"), np.dtype("<i4"), np.dtype("<f8"))


def cache_folder(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the folder of the cache: below XDG_CACHE_HOME, by default ~/.cache."""
    base = environ.get("XDG_CACHE_HOME", "")
    # The XDG specification says to ignore relative paths.
    root = Path(base) if os.path.isabs(base) else Path.home() / ".cache"
    return root / "arm-suite" / "meshes"


class MeshCache:
    """The parts of mesh files, by a key of their content.

    An entry that cannot be read or written is ignored: the cache never keeps a robot from starting.
    The folder is created when the first entry is written.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @staticmethod
    def key(suffix: str, contents: Iterable[bytes]) -> str:
        """Return the key of a mesh, a digest of its format and the bytes of its files."""
        digest = hashlib.blake2b(f"{VERSION} {suffix}".encode(), digest_size=24)
        for content in contents:
            digest.update(len(content).to_bytes(8, "little"))
            digest.update(content)
        return digest.hexdigest()

    def load(self, key: str) -> tuple[MeshPart, ...] | None:
        """Return the parts stored under a key; None if there is no usable entry."""
        path = self._path(key)
        try:
            content = path.read_bytes()
            parts = tuple(_parts(_undamaged(content)))
            # The time of the last use decides which entry is deleted first.
            os.utime(path)
        except FileNotFoundError:
            return None
        except (OSError, MeshFileError) as error:
            logger.debug("the cached mesh %s is not usable: %s", path, error)
            return None
        return parts or None

    def store(self, key: str, parts: Sequence[MeshPart]) -> None:
        """Store the parts under a key atomically: a reader sees the whole entry or nothing."""
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            content = b"".join(map(_bytes_of, parts))
            self._write(key, _CHECKSUM.pack(zlib.crc32(content)) + content)
            self._make_room()
        except (OSError, MeshFileError) as error:
            logger.debug("cannot cache a mesh in %s: %s", self._folder, error)

    def _write(self, key: str, content: bytes) -> None:
        handle, name = tempfile.mkstemp(dir=self._folder, suffix=".new")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            os.replace(name, self._path(key))
        except BaseException:  # No exception may leave an incomplete file behind.
            os.unlink(name)
            raise

    def _make_room(self) -> None:
        entries = []
        for file in (file for suffix in SUFFIXES for file in self._folder.glob(f"*{suffix}")):
            with contextlib.suppress(FileNotFoundError):
                status = file.stat()
                entries.append((status.st_mtime, status.st_size, file))
        total = sum(size for _, size, _ in entries)
        for _, size, file in sorted(entries):
            if total <= MAX_CACHE_BYTES:
                break
            file.unlink(missing_ok=True)
            total -= size

    def _path(self, key: str) -> Path:
        return self._folder / f"{key}{SUFFIXES[0]}"


def _bytes_of(part: MeshPart) -> bytes:
    """Return a part as it is stored.

    Raises:
        MeshFileError: it cannot be drawn.
    """
    part.drawn.check()
    hull = part.hull[:0] if part.hull is part.drawn.vertices else part.hull
    arrays = (part.drawn.vertices, part.drawn.faces, hull)
    rgba = (math.nan,) * 4 if part.drawn.rgba is None else part.drawn.rgba
    stored = zip(_TYPES, arrays, strict=True)
    return _SIZES.pack(*map(len, arrays), part.triangles, part.different, *rgba) + b"".join(
        np.ascontiguousarray(array, kind).tobytes() for kind, array in stored
    )


def _undamaged(content: bytes) -> memoryview:
    """Return an entry without its checksum.

    Raises:
        MeshFileError: the checksum is not that of the rest.
    """
    rest = memoryview(content)[_CHECKSUM.size :]
    if content[: _CHECKSUM.size] != _CHECKSUM.pack(zlib.crc32(rest)):
        raise MeshFileError("it is damaged")
    return rest


def _parts(content: memoryview) -> Iterator[MeshPart]:
    """Yield the parts of an entry; their arrays are read-only."""
    at = 0
    while at < len(content):
        *sizes, triangles, different, red, green, blue, alpha = _SIZES.unpack_from(content, at)
        at += _SIZES.size
        arrays: list[NDArray[Any]] = []
        for kind, size in zip(_TYPES, sizes, strict=True):
            arrays.append(np.frombuffer(content, kind, 3 * size, at).reshape(-1, 3))
            at += arrays[-1].nbytes
        vertices, faces, hull = arrays
        rgba = None if math.isnan(red) else (red, green, blue, alpha)
        drawn = MeshData(vertices, faces, rgba)
        yield MeshPart(drawn, hull if len(hull) else vertices, triangles, different)
