"""The meshes of one model: each file read once, each part an asset of the MjSpec."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri
from arm_description.robot import Mesh
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh_data import Color, MeshData
from arm_gazebo.scene_file import read_scene
from arm_gazebo.stl_file import read_stl

SCENE_SUFFIXES = (".obj", ".dae", ".glb", ".gltf", ".ply", ".off", ".3mf")


@dataclass(frozen=True, slots=True)
class MeshAsset:
    """A mesh of the model: its name there and the colour that its file gives."""

    name: str
    rgba: Color | None


class MeshLibrary:
    """Reads mesh files and adds them to a specification, each file and scale once."""

    def __init__(self, spec: mujoco.MjSpec, package_path: Sequence[Path] = ()) -> None:
        self._spec = spec
        self._package_path = package_path
        self._parts: dict[Path, tuple[MeshData, ...]] = {}
        self._assets: dict[tuple[Path, tuple[float, float, float]], tuple[MeshAsset, ...]] = {}

    def parts(self, mesh: Mesh) -> tuple[MeshData, ...]:
        """Return the parts of a mesh in m, in its own frame, scaled.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        return tuple(part.scaled(mesh.scale) for part in self._read(self._resolve(mesh)))

    def assets(self, mesh: Mesh) -> tuple[MeshAsset, ...]:
        """Return the assets of a mesh, added to the specification where they are not yet.

        Raises:
            MeshError: the file cannot be found or read; the message names it.
        """
        path = self._resolve(mesh)
        key = (path, mesh.scale)
        if key not in self._assets:
            parts = [part.scaled(mesh.scale) for part in self._read(path)]
            self._assets[key] = tuple(self._add(path, part) for part in parts)
        return self._assets[key]

    def _resolve(self, mesh: Mesh) -> Path:
        try:
            return resolve_uri(mesh.uri, self._package_path).resolve()
        except ResourceNotFoundError as error:
            raise MeshError(str(error)) from error

    def _read(self, path: Path) -> tuple[MeshData, ...]:
        if path not in self._parts:
            try:
                self._parts[path] = _usable(_read_parts(path))
            except (MeshError, OSError) as error:
                raise MeshError(f"cannot use the mesh {path}: {error}") from error
        return self._parts[path]

    def _add(self, path: Path, part: MeshData) -> MeshAsset:
        name = self._free_name(path.stem)
        self._spec.add_mesh(
            name=name,
            uservert=part.vertices.ravel(),
            userface=part.faces.ravel(),
            # Links bring their own inertia; this one takes open and flat meshes too.
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        return MeshAsset(name, part.rgba)

    def _free_name(self, stem: str) -> str:
        name, number = stem, 1
        while self._spec.mesh(name) is not None:
            number += 1
            name = f"{stem}_{number}"
        return name


def _usable(parts: Sequence[MeshData]) -> tuple[MeshData, ...]:
    """Return the parts that can be drawn; exporters leave empty ones behind."""
    usable = []
    problem = MeshError("nothing in it")
    for part in parts:
        try:
            part.check()
            usable.append(part)
        except MeshError as error:
            problem = error
    if not usable:
        raise problem
    return tuple(usable)


def _read_parts(path: Path) -> tuple[MeshData, ...]:
    suffix = path.suffix.lower()
    if suffix == ".stl":
        return (read_stl(path.read_bytes()),)
    if suffix in SCENE_SUFFIXES:
        return read_scene(path)
    raise MeshError(f"'{suffix}' is not one of .stl, {', '.join(SCENE_SUFFIXES)}")
