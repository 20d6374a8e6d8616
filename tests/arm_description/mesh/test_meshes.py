"""The arm's meshes have the original's size; mesh files that would block a reader are refused."""

import os

import numpy as np
import pytest
import trimesh

from arm_description import resolve_uri
from arm_description.errors import MeshFileError
from arm_description.mesh.file import check_mesh_file, read_mesh_file
from arm_description.mesh.scene_graph import SceneNode, check_scene

MESHES = resolve_uri("package://arm_description/meshes")

BOUNDS = {
    ("base_link",): ((-45.18, -45.15, -31.32), (45.18, 44.93, 48.68)),
    ("base_turn",): ((-28.53, -27.87, -1.94), (31.47, 50.38, 5.06)),
    ("base_turn_table_rot",): ((-28.0, -27.8, -7.11), (28.0, 27.8, 13.59)),
    ("dyn", "dyn_trim", "dyn_horn"): ((-11.5, -16.0, -19.0), (38.5, 16.0, 21.0)),
    ("f4_n_f3",): ((-27.35, -60.29, -14.26), (20.65, 31.34, 14.35)),
    ("wrist",): ((-20.19, -27.34, -31.45), (28.02, 27.37, 11.5)),
    ("the_crawer_base",): ((-52.23, -23.99, -2.0), (52.17, 33.81, 3.0)),
    ("the_crawer",): ((-14.7, -15.6, -14.16), (48.2, 15.6, 26.66)),
}
"""Bounding boxes of the original's meshes in mm, by the files that stand for each."""


@pytest.mark.parametrize(("files", "bounds"), BOUNDS.items(), ids=lambda value: str(value))
def test_a_part_is_as_large_as_the_original(files, bounds):
    meshes = [trimesh.load_mesh(MESHES / f"{name}.stl") for name in files]

    lower = np.min([mesh.bounds[0] for mesh in meshes], axis=0) * 1000
    upper = np.max([mesh.bounds[1] for mesh in meshes], axis=0) * 1000
    assert np.array([lower, upper]) == pytest.approx(np.array(bounds), abs=1.0)


def test_the_foot_is_flat_below():
    mesh = trimesh.load_mesh(MESHES / "base_link.stl")

    down = mesh.facets_normal[:, 2] < -0.999
    underside = [facet for facet, is_down in zip(mesh.facets, down, strict=True) if is_down]
    lowest = max(underside, key=lambda facet: mesh.area_faces[facet].sum())
    assert mesh.triangles[lowest][:, :, 2] == pytest.approx(-0.0313, abs=1e-7)
    assert mesh.area_faces[lowest].sum() > 0.007


def test_all_meshes_together_are_small():
    assert sum(path.stat().st_size for path in MESHES.iterdir()) < 400_000


def test_a_large_geometry_is_not_drawn_a_thousand_times():
    nodes = {"a": SceneNode(0, ("b",) * 9000), "b": SceneNode(1, (), 4000)}
    with pytest.raises(MeshFileError, match="with more than 30000000 corners"):
        check_scene(["a"], nodes.get)


@pytest.mark.parametrize("target", ["fifo", "/dev/zero"])
def test_materials_that_are_not_a_regular_file_leave_an_obj_without_colour(tmp_path, target):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link.mtl").symlink_to(target)
    text = trimesh.exchange.obj.export_obj(trimesh.creation.box([0.1, 0.1, 0.1]))
    (tmp_path / "a.obj").write_text(f"mtllib link.mtl\n{text}")
    [mesh] = read_mesh_file(tmp_path / "a.obj")
    assert len(mesh.faces) == 12


def test_a_fifo_is_not_a_mesh(tmp_path):
    os.mkfifo(tmp_path / "a.stl")
    with pytest.raises(MeshFileError, match="it is a FIFO, not a regular file"):
        check_mesh_file(tmp_path / "a.stl")
