"""A cache of parsed meshes in the user's cache folder, keyed by the content of their files."""

import contextlib
import hashlib
import logging
import os
import tempfile
import zipfile
import zlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData
from arm_gazebo.mesh.part import MeshPart

logger = logging.getLogger(__name__)

VERSION = "3"
"""Part of every key. Raise it when the same file is parsed to a different result."""
MAX_CACHE_BYTES = 1_000_000_000
"""Limit on the size of all entries; the least recently used are deleted first."""

# numpy raises any of these for a broken file.
_READ_ERRORS = (
    *(OSError, ValueError, TypeError, KeyError, EOFError, MeshFileError),
    *(zipfile.BadZipFile, zlib.error, RuntimeError),
)


def cache_folder(environ: Mapping[str, str] = os.environ) -> Path:
    """Return the folder of the cache: below XDG_CACHE_HOME, by default ~/.cache."""
    base = environ.get("XDG_CACHE_HOME", "")
    # The XDG specification says to ignore relative paths.
    root = Path(base) if os.path.isabs(base) else Path.home() / ".cache"
    return root / "arm-suite" / "meshes"


class MeshCache:
    """The parts of mesh files, by a key of their content.

    An entry that cannot be read or written is ignored: the cache never keeps a robot from starting.

    Args:
        folder: folder of the entries; created when the first one is written.
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
            with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                parts = tuple(_part(arrays, index) for index in range(int(arrays["count"])))
            for part in parts:
                part.drawn.check()
            # The time of the last use decides which entry is deleted first.
            os.utime(path)
        except FileNotFoundError:
            return None
        except _READ_ERRORS as error:
            logger.debug("the cached mesh %s is not usable: %s", path, error)
            return None
        return parts or None

    def store(self, key: str, parts: Sequence[MeshPart]) -> None:
        """Store the parts under a key atomically: a reader sees the whole entry or nothing."""
        arrays: dict[str, NDArray[np.generic]] = {"count": np.array(len(parts))}
        for index, part in enumerate(parts):
            arrays[f"vertices{index}"] = part.drawn.vertices
            arrays[f"faces{index}"] = part.drawn.faces
            arrays[f"hull{index}"] = part.hull
            arrays[f"triangles{index}"] = np.array(part.triangles)
            if part.drawn.rgba is not None:
                arrays[f"rgba{index}"] = np.array(part.drawn.rgba)
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._write(key, arrays)
            self._make_room()
        except OSError as error:
            logger.debug("cannot cache a mesh in %s: %s", self._folder, error)

    def _write(self, key: str, arrays: Mapping[str, NDArray[np.generic]]) -> None:
        handle, name = tempfile.mkstemp(dir=self._folder, suffix=".new")
        try:
            with os.fdopen(handle, "wb") as file:
                np.savez(file, allow_pickle=False, **arrays)
            os.replace(name, self._path(key))
        except BaseException:  # No exception may leave an incomplete file behind.
            os.unlink(name)
            raise

    def _make_room(self) -> None:
        entries = []
        for file in self._folder.glob("*.npz"):
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
        return self._folder / f"{key}.npz"


def _part(arrays: Mapping[str, NDArray[np.generic]], index: int) -> MeshPart:
    rgba = None
    if f"rgba{index}" in arrays:
        red, green, blue, alpha = np.asarray(arrays[f"rgba{index}"], np.float64).tolist()
        rgba = (red, green, blue, alpha)
    vertices = np.asarray(arrays[f"vertices{index}"], np.float64)
    faces = np.asarray(arrays[f"faces{index}"], np.int32)
    hull = np.asarray(arrays[f"hull{index}"], np.float64)
    return MeshPart(MeshData(vertices, faces, rgba), hull, int(arrays[f"triangles{index}"]))
