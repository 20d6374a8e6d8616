"""The arm's meshes: like the original's in size; test_made_meshes.py has what all robots share."""

import numpy as np
import pytest
import trimesh

from arm_description import resolve_uri

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
