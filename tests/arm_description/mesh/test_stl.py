"""STL files, binary and text, against MuJoCo's reader, which reads only binary ones."""

import mujoco
import numpy as np
import pytest
import trimesh

from arm_description.mesh.file import read_mesh_file


def measures(vertices, faces):
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    return [mesh.area, mesh.volume, *np.ravel(mesh.bounds)]


def measures_of_mujoco(path):
    spec = mujoco.MjSpec()
    spec.add_mesh(name="m", file=str(path))
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="m")
    model = spec.compile()
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.mesh_quat[0])
    return measures(model.mesh_vert @ rotation.reshape(3, 3).T + model.mesh_pos[0], model.mesh_face)


@pytest.mark.parametrize("kind", ["stl", "stl_ascii"])
def test_area_volume_and_bounds_are_those_that_mujoco_reads(tmp_path, kind):
    ring = trimesh.creation.annulus(0.1, 0.3, 0.5)
    ring.apply_translation([1.0, 2.0, 3.0])
    ring.export(tmp_path / "binary.stl")
    ring.export(tmp_path / "ring.stl", file_type=kind)
    (part,) = read_mesh_file(tmp_path / "ring.stl")
    ours = measures(part.vertices, part.faces)
    assert ours == pytest.approx(measures_of_mujoco(tmp_path / "binary.stl"), rel=1e-5)
