"""The meshes of one model: each file is read once, and each part is an asset of the MjSpec."""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import MeshFileError, ResourceNotFoundError
from arm_description.mesh.data import LARGEST_BYTES, Color, Scale
from arm_description.mesh.file import OBJ_SUFFIX, check_mesh_file, read_mesh_file
from arm_description.mesh.obj import material_files
from arm_description.resources import ResourceFinder
from arm_description.urdf.robot import Mesh
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.part import MeshPart
from arm_node.frozen import frozen
from arm_node.user_file import read_bytes

T = TypeVar("T")

MULTI_FILE_SUFFIXES = (".gltf",)
"""Formats that refer to data in other files, so that the content of one file is not the key."""
MATERIALS = re.compile(rb"^\s*mtllib\s+(\S.*?)\s*$", re.MULTILINE)


@frozen
class MeshAsset:
    """A mesh of the model: its name in the model and the colour from its file."""

    name: str
    rgba: Color | None


class MeshLibrary:
    """Reads mesh files and adds them to a specification, each file and scale once.

    `cache` has the meshes that earlier runs read; None reads every file.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        resources: ResourceFinder,
        cache: MeshCache | None = None,
    ) -> None:
        self._spec = spec
        self._resources = resources
        self._cache = cache
        self._paths: dict[str, Path] = {}
        self._folders: dict[Path, Path] = {}
        self._parts: dict[Path, tuple[MeshPart, ...]] = {}
        self._unusable: dict[Path, str] = {}
        self._scaled: dict[tuple[Path, Scale], tuple[MeshPart, ...]] = {}
        self._assets: dict[tuple[Path, Scale, Callable[..., str]], tuple[MeshAsset, ...]] = {}

    def parts(self, mesh: Mesh) -> tuple[MeshPart, ...]:
        """Return the scaled parts of a mesh in its own frame, in m.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        path = self._resolve(mesh)
        key = (path, mesh.scale)
        if key not in self._scaled:
            parts = self._read(path)
            try:
                self._scaled[key] = _drawable_parts(parts, lambda part: part.scaled(mesh.scale))
            except MeshError as error:
                raise MeshError(f"cannot use the mesh {path}: {error}") from error
        return self._scaled[key]

    def assets(self, mesh: Mesh, user: str = "") -> tuple[MeshAsset, ...]:
        """Return the visual parts of a mesh, and add new ones to the specification.

        MuJoCo's message names `user`, the element that uses it, if it does not compile.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        return self._added(mesh, self._add_drawn, user)

    def hulls(self, mesh: Mesh, user: str = "") -> tuple[MeshAsset, ...]:
        """Return the collision parts of a mesh, and add new ones to the specification.

        MuJoCo's message names `user`, the element that uses it, if it does not compile.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        if all(part.is_small() for part in self._read(self._resolve(mesh))):
            return self.assets(mesh, user)
        return self._added(mesh, self._add_hull, user)

    def thickened(self, mesh: Mesh, part: MeshPart, user: str = "") -> MeshAsset:
        """Return a flat part of a mesh made thick enough to collide; a new asset at each call."""
        path = self._resolve(mesh)
        name = self._add_hull(path.stem, part)
        self._describe(name, path, user)
        return MeshAsset(name, part.drawn.rgba)

    def _added(
        self, mesh: Mesh, add: Callable[[str, MeshPart], str], user: str
    ) -> tuple[MeshAsset, ...]:
        path = self._resolve(mesh)
        key = (path, mesh.scale, add)
        if key not in self._assets:
            self._assets[key] = tuple(
                MeshAsset(add(path.stem, part), part.drawn.rgba) for part in self.parts(mesh)
            )
            for asset in self._assets[key]:
                self._describe(asset.name, path, user)
        return self._assets[key]

    def _describe(self, name: str, path: Path, user: str) -> None:
        # MuJoCo appends this to its message if it cannot compile the mesh.
        self._spec.mesh(name).info = f"file {path}" + (f", {user}" if user else "")

    def _add_drawn(self, stem: str, part: MeshPart) -> str:
        return self._add(stem, part.drawn.vertices, part.drawn.faces)

    def _add_hull(self, stem: str, part: MeshPart) -> str:
        # MuJoCo draws a mesh without triangles as its hull, which a flat one does not have.
        hull = part.thickened().hull if part.is_flat() else part.hull
        return self._add(f"{stem}_hull", hull, np.empty((0, 3), np.int32))

    def _add(self, stem: str, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> str:
        name = self._free_name(stem)
        self._spec.add_mesh(
            name=name,
            # The bindings take an array element by element, which takes twice as long as a list.
            uservert=vertices.ravel().tolist(),
            userface=faces.ravel().tolist(),
            # Links have their own inertia; this type also accepts open and flat meshes.
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
        if mesh.uri not in self._paths:
            try:
                self._paths[mesh.uri] = self._without_links(self._resources.find(mesh.uri))
            except ResourceNotFoundError as error:
                raise MeshError(str(error)) from error
        return self._paths[mesh.uri]

    def _without_links(self, path: Path) -> Path:
        """Return what `path.resolve()` returns; the folder of many meshes is followed once."""
        if path.is_symlink() or path.name == "..":
            return path.resolve()
        if path.parent not in self._folders:
            self._folders[path.parent] = path.parent.resolve()
        return self._folders[path.parent] / path.name

    def _read(self, path: Path) -> tuple[MeshPart, ...]:
        if path not in self._parts and path not in self._unusable:
            try:
                self._parts[path] = self._read_through_cache(path)
            except (MeshError, MeshFileError, OSError) as error:
                self._unusable[path] = f"cannot use the mesh {path}: {error}"
        if path in self._unusable:
            raise MeshError(self._unusable[path])
        return self._parts[path]

    def _read_through_cache(self, path: Path) -> tuple[MeshPart, ...]:
        if self._cache is None or path.suffix.lower() in MULTI_FILE_SUFFIXES:
            return _new_parts(path)
        key = self._cache.key(path.suffix.lower(), _contents(path))
        parts = self._cache.load(key)
        if parts is None:
            parts = _new_parts(path)
            self._cache.store(key, parts)
        return parts


def _new_parts(path: Path) -> tuple[MeshPart, ...]:
    """Check and read a file; what the cache has of one was checked before."""
    check_mesh_file(path)
    return _drawable_parts(read_mesh_file(path), MeshPart.of)


def _contents(path: Path) -> Iterator[bytes]:
    """Yield the bytes of a mesh file, and of the material files that an .obj names."""
    content = read_bytes(path, LARGEST_BYTES)
    yield content
    if path.suffix.lower() == OBJ_SUFFIX:
        # A missing file is part of the key as well, because it may appear later.
        yield from material_files(path.parent, MATERIALS.findall(content))


def _drawable_parts(parts: Iterable[T], convert: Callable[[T], MeshPart]) -> tuple[MeshPart, ...]:
    """Convert the parts and drop those that fail, because exporters leave empty parts behind.

    Raises:
        MeshError: no part can be drawn; the message is that of the last one.
    """
    drawable = []
    problem = MeshError("it is empty")
    for part in parts:
        try:
            drawable.append(convert(part))
        except MeshError as error:
            problem = error
    if not drawable:
        raise problem
    return tuple(drawable)
