"""A cache of parsed meshes in the user's cache folder, keyed by the content of their files."""

import contextlib
import hashlib
import io
import logging
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData
from arm_gazebo.mesh.part import MeshPart

logger = logging.getLogger(__name__)

VERSION = "4"
"""Part of every key. Raise it when the same file is parsed to a different result."""
MAX_CACHE_BYTES = 1_000_000_000
"""Limit on the size of all entries; the least recently used are deleted first."""

_DIGEST_BYTES = 24
"""An entry begins with a digest of the rest of it, so that no damaged one is used."""


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
            content = path.read_bytes()
            if _digest(content[_DIGEST_BYTES:]) != content[:_DIGEST_BYTES]:
                raise MeshFileError("it is damaged")
            parts = _parts(io.BytesIO(content[_DIGEST_BYTES:]))
            for part in parts:
                part.drawn.check()
            # The time of the last use decides which entry is deleted first.
            os.utime(path)
        except FileNotFoundError:
            return None
        except (OSError, ValueError, EOFError, MeshFileError) as error:
            logger.debug("the cached mesh %s is not usable: %s", path, error)
            return None
        return parts or None

    def store(self, key: str, parts: Sequence[MeshPart]) -> None:
        """Store the parts under a key atomically: a reader sees the whole entry or nothing."""
        file = io.BytesIO()
        # One array after another: to read ten of them from a zip file takes five times as long.
        np.save(file, len(parts))
        for part in parts:
            rgba = () if part.drawn.rgba is None else part.drawn.rgba
            for array in (part.drawn.vertices, part.drawn.faces, part.hull, part.triangles, rgba):
                np.save(file, array)
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._write(key, _digest(file.getvalue()) + file.getvalue())
            self._make_room()
        except OSError as error:
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
        for file in self._folder.glob("*.np[yz]"):  # .npz: entries of earlier versions.
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
        return self._folder / f"{key}.npy"


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=_DIGEST_BYTES).digest()


def _parts(file: io.BytesIO) -> tuple[MeshPart, ...]:
    """Return the parts whose arrays are in a file, in the order of `store`."""
    parts: list[MeshPart] = []
    for _ in range(int(np.load(file))):
        vertices, faces, hull, triangles, rgba = (np.load(file) for _ in range(5))
        color = None if rgba.size == 0 else tuple(rgba.tolist())
        parts.append(MeshPart(MeshData(vertices, faces, color), hull, int(triangles)))
    return tuple(parts)
