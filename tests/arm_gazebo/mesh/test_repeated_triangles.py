"""A mesh that draws the same triangles several times is remarked on."""

import numpy as np
import pytest
import trimesh

from arm_description.mesh.data import MeshData


def build(parts, file):
    shape = f'<visual><geometry><mesh filename="{file}"/></geometry></visual>'
    inertia = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    inertial = f'<inertial><mass value="1"/>{inertia}</inertial>'
    return parts.build(f'<robot name="r"><link name="base">{inertial}{shape * 2}</link></robot>')


@pytest.fixture
def box():
    return trimesh.creation.box([1.0, 1.0, 1.0])


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb", "off"])
def test_it_is_said_once_how_many_are_different(parts, tmp_path, box, suffix):
    file = tmp_path / f"box.{suffix}"
    turned = np.roll(box.faces[:4], 1, axis=1)
    faces = np.concatenate([box.faces[:4], turned, box.faces[:4]])
    trimesh.Trimesh(box.vertices, faces, process=False).export(file)
    [warning] = [str(finding) for finding in build(parts, file).report.warnings]
    assert f"of the 12 triangles of its mesh {file} only 4 are different" in warning


def test_both_sides_of_a_sheet_are_no_repetition(parts, tmp_path, box):
    faces = np.concatenate([box.faces, box.faces[:, ::-1]])
    trimesh.Trimesh(box.vertices, faces, process=False).export(tmp_path / "both.stl")
    assert build(parts, tmp_path / "both.stl").report.warnings == ()


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_triangles_on_round_and_symmetric_places_are_different(kind):
    places = np.stack(np.meshgrid(*[np.arange(-8, 9)] * 3), axis=-1).reshape(-1, 3) / 4
    faces = np.random.default_rng(0).permuted(np.tile(np.arange(len(places)), (3, 1)), axis=1).T
    different = len({tuple(sorted(face)) for face in faces.tolist() if len(set(face)) == 3})
    faces = faces[[len(set(face)) == 3 for face in faces.tolist()]].astype(np.int32)
    mesh = MeshData(places.astype(kind).astype(np.float64), faces)
    assert mesh.different_faces() == different
