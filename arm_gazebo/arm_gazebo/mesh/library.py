"""The meshes of one model: each file read once, each part an asset of the MjSpec."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError, ResourceNotFoundError
from arm_description.mesh_data import Color, Scale
from arm_description.mesh_file import check_mesh_file, read_mesh_file
from arm_description.resources import resolve_uri
from arm_description.robot import Mesh
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.part import MeshPart

T = TypeVar("T")

SCATTERED_SUFFIXES = (".gltf",)
"""Formats whose data lie in other files, so that one file's content does not tell all."""
MATERIALS = re.compile(rb"^\s*mtllib\s+(\S.*?)\s*$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class MeshAsset:
    """A mesh of the model: its name there and the colour that its file gives."""

    name: str
    rgba: Color | None


class MeshLibrary:
    """Reads mesh files and adds them to a specification, each file and scale once.

    Args:
        spec: gets the meshes.
        package_path: folders searched after the installed packages.
        cache: what was read by earlier runs; None to read everything anew.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        package_path: Sequence[Path] = (),
        cache: MeshCache | None = None,
    ) -> None:
        self._spec = spec
        self._package_path = package_path
        self._cache = cache
        self._parts: dict[Path, tuple[MeshPart, ...]] = {}
        self._assets: dict[tuple[Path, Scale, Callable[..., str]], tuple[MeshAsset, ...]] = {}

    def parts(self, mesh: Mesh) -> tuple[MeshPart, ...]:
        """Return the parts of a mesh in m, in its own frame, scaled.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        path = self._resolve(mesh)
        parts = self._read(path)
        try:
            return _usable(parts, lambda part: part.scaled(mesh.scale))
        except MeshError as error:
            raise MeshError(f"cannot use the mesh {path}: {error}") from error

    def assets(self, mesh: Mesh) -> tuple[MeshAsset, ...]:
        """Return the parts of a mesh to be drawn, added to the specification if they are new.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        return self._added(mesh, self._add_drawn)

    def hulls(self, mesh: Mesh) -> tuple[MeshAsset, ...]:
        """Return the parts of a mesh to be touched, added to the specification if they are new.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        if all(part.is_small() for part in self._read(self._resolve(mesh))):
            return self.assets(mesh)
        return self._added(mesh, self._add_hull)

    def _added(self, mesh: Mesh, add: Callable[[str, MeshPart], str]) -> tuple[MeshAsset, ...]:
        path = self._resolve(mesh)
        key = (path, mesh.scale, add)
        if key not in self._assets:
            self._assets[key] = tuple(
                MeshAsset(add(path.stem, part), part.drawn.rgba) for part in self.parts(mesh)
            )
        return self._assets[key]

    def _add_drawn(self, stem: str, part: MeshPart) -> str:
        return self._add(stem, part.drawn.vertices, part.drawn.faces.ravel())

    def _add_hull(self, stem: str, part: MeshPart) -> str:
        # Without triangles of its own a mesh is drawn as its hull.
        return self._add(f"{stem}_hull", part.hull, np.empty(0, np.int32))

    def _add(self, stem: str, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> str:
        name = self._free_name(stem)
        self._spec.add_mesh(
            name=name,
            uservert=vertices.ravel(),
            userface=faces,
            # Links bring their own inertia; this one takes open and flat meshes too.
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        return name

    def _free_name(self, stem: str) -> str:
        name, number = stem, 1
        while self._spec.mesh(name) is not None:
            number += 1
            name = f"{stem}_{number}"
        return name

    def _resolve(self, mesh: Mesh) -> Path:
        try:
            return resolve_uri(mesh.uri, self._package_path).resolve()
        except ResourceNotFoundError as error:
            raise MeshError(str(error)) from error

    def _read(self, path: Path) -> tuple[MeshPart, ...]:
        if path not in self._parts:
            try:
                self._parts[path] = self._read_or_remember(path)
            except (MeshError, MeshFileError, OSError) as error:
                raise MeshError(f"cannot use the mesh {path}: {error}") from error
        return self._parts[path]

    def _read_or_remember(self, path: Path) -> tuple[MeshPart, ...]:
        check_mesh_file(path)
        if self._cache is None or path.suffix.lower() in SCATTERED_SUFFIXES:
            return _usable(read_mesh_file(path), MeshPart.of)
        key = self._cache.key(path.suffix.lower(), _contents(path))
        parts = self._cache.load(key)
        if parts is None:
            parts = _usable(read_mesh_file(path), MeshPart.of)
            self._cache.store(key, parts)
        return parts


def _contents(path: Path) -> Iterator[bytes]:
    """Yield the bytes of a mesh file, and of the materials' files that an .obj names."""
    content = path.read_bytes()
    yield content
    for name in MATERIALS.findall(content) if path.suffix.lower() == ".obj" else ():
        materials = path.parent / name.decode("utf-8", "replace")
        # A file that is not there is a content, too: it may come later.
        yield materials.read_bytes() if materials.is_file() else b""


def _usable(parts: Iterable[T], made: Callable[[T], MeshPart]) -> tuple[MeshPart, ...]:
    """Return what is made of the parts that can be drawn; exporters leave empty ones behind."""
    usable = []
    problem = MeshError("nothing in it")
    for part in parts:
        try:
            usable.append(made(part))
        except MeshError as error:
            problem = error
    if not usable:
        raise problem
    return tuple(usable)
