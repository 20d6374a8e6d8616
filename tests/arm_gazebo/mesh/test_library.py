"""The meshes of one model."""

import mujoco
import pytest
import trimesh

from arm_description import ResourceFinder
from arm_description.mesh.file import read_mesh_file
from arm_description.urdf.robot import Mesh
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh import library


def test_an_unusable_file_is_read_once_and_named_at_each_use(tmp_path, monkeypatch):
    (tmp_path / "box.stl").write_bytes(b"solid")
    read = []

    def reading(path):
        read.append(path)
        return read_mesh_file(path)

    monkeypatch.setattr(library, "read_mesh_file", reading)
    meshes = library.MeshLibrary(mujoco.MjSpec(), ResourceFinder(None))
    box = Mesh(str(tmp_path / "box.stl"))
    for use in (meshes.assets, meshes.hulls, meshes.parts):
        with pytest.raises(MeshError, match=r"cannot use the mesh .*box\.stl: a text STL"):
            use(box)
    assert read == [tmp_path / "box.stl"]


def test_a_mesh_is_read_and_scaled_once(tmp_path):
    trimesh.creation.box([1.0, 1.0, 1.0]).export(tmp_path / "box.stl")
    meshes = library.MeshLibrary(mujoco.MjSpec(), ResourceFinder(None))
    (part,) = meshes.parts(Mesh(str(tmp_path / "box.stl")))
    (larger,) = meshes.parts(Mesh(str(tmp_path / "box.stl"), scale=(2.0, 1.0, 1.0)))
    assert meshes.parts(Mesh(str(tmp_path / "box.stl")))[0] is part
    assert part.bounds[1].tolist() == [0.5, 0.5, 0.5]
    assert larger.bounds[1].tolist() == [1.0, 0.5, 0.5]
