"""Collision hulls and coarser visuals of meshes with too many vertices."""

import numpy as np
import pytest
import trimesh

from arm_description.errors import MeshFileError
from arm_description.mesh.data import MeshData
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh import simplification
from arm_gazebo.mesh.part import MeshPart
from arm_gazebo.mesh.simplification import HULL_DIRECTIONS, outermost, simplified


def mesh_data(mesh):
    return MeshData(np.asarray(mesh.vertices), np.asarray(mesh.faces, np.int32))


def ball(subdivisions=5, scale=(1.0, 1.0, 1.0)):
    mesh = trimesh.creation.icosphere(subdivisions, 0.1)
    mesh.vertices *= scale
    return mesh_data(mesh)


@pytest.mark.parametrize("scale", [(1, 1, 1), (10, 1, 0.1), (1, 1, 1e-3)])
def test_the_hull_of_the_outermost_vertices_is_nearly_the_hull_of_all(scale):
    every = ball(scale=scale).vertices
    few = outermost(every)
    assert len(few) <= HULL_DIRECTIONS
    assert trimesh.convex.convex_hull(few).volume == pytest.approx(
        trimesh.convex.convex_hull(every).volume, rel=0.02
    )


def test_the_hull_reaches_as_far_as_the_mesh():
    every = ball(scale=(3.0, 1.0, 0.5)).vertices
    few = outermost(every)
    assert few.min(axis=0) == pytest.approx(every.min(axis=0))
    assert few.max(axis=0) == pytest.approx(every.max(axis=0))


def test_corners_stay_corners():
    box = trimesh.creation.box([0.1, 0.2, 0.3])
    for _ in range(5):
        box = box.subdivide()
    assert len(box.vertices) > HULL_DIRECTIONS
    hull = trimesh.convex.convex_hull(outermost(box.vertices))
    assert hull.volume == pytest.approx(0.1 * 0.2 * 0.3)


def test_few_vertices_are_left_alone():
    every = ball(2).vertices
    assert outermost(every) is every


def test_a_huge_mesh_gets_coarser_and_keeps_its_shape():
    mesh = ball(6)
    coarse = simplified(mesh, 20_000)
    assert 5_000 < len(coarse.faces) <= 20_000
    coarse.check()
    volume = trimesh.Trimesh(coarse.vertices, coarse.faces, process=False).volume
    assert volume == pytest.approx(4 / 3 * np.pi * 0.1**3, rel=0.02)


def test_a_usual_mesh_is_drawn_as_it_is():
    mesh = ball(3)
    assert simplified(mesh) is mesh


def test_a_part_knows_whether_it_is_flat_and_how_large_it_is():
    plate = trimesh.creation.box([1.0, 1.0, 1.0])
    plate.vertices *= (0.5, 0.2, 0.0)
    part = MeshPart.of(mesh_data(plate))
    assert part.is_flat()
    assert part.scaled((1.0, 2.0, 1.0)).bounds[1] == pytest.approx([0.25, 0.2, 0.0])
    assert not MeshPart.of(ball(4)).is_flat()


@pytest.mark.parametrize("shape", ["ball", "cube", "needle", "two balls"])
def test_many_vertices_have_the_outermost_that_a_search_of_all_finds(monkeypatch, shape):
    random = np.random.default_rng(1)
    every = random.normal(size=(20_000, 3))
    if shape == "ball":
        every /= np.linalg.norm(every, axis=1)[:, None]
    elif shape == "cube":
        every = random.uniform(-1, 1, size=every.shape)
    elif shape == "needle":
        every *= (100.0, 1.0, 0.01)
    else:
        every[:10_000] += (50.0, 20.0, 0.0)
    monkeypatch.setattr(simplification, "MANY_VERTICES", len(every))
    searched = outermost(every)
    monkeypatch.setattr(simplification, "MANY_VERTICES", 1000)
    assert (outermost(every) == searched).all()


def test_large_loose_triangles_are_refused_in_a_sentence():
    random = np.random.default_rng(1)
    vertices = random.uniform(-1, 1, size=(90_000, 3))
    loose = MeshData(vertices, np.arange(90_000, dtype=np.int32).reshape(-1, 3))
    with pytest.raises(MeshFileError, match="its 30000 triangles cannot be reduced to the 2000 "):
        simplified(loose, 2000)


def test_small_loose_triangles_become_a_coarse_mesh():
    random = np.random.default_rng(1)
    middles = random.uniform(-1, 1, size=(30_000, 1, 3))
    corners = middles + random.uniform(-1e-3, 1e-3, size=(30_000, 3, 3))
    loose = MeshData(corners.reshape(-1, 3), np.arange(90_000, dtype=np.int32).reshape(-1, 3))
    assert 0 < len(simplified(loose, 2000).faces) <= 2000


def test_a_part_that_cannot_be_drawn_is_an_error_of_the_mesh(monkeypatch):
    def refuse(mesh):
        raise MeshFileError("too large")

    monkeypatch.setattr("arm_gazebo.mesh.part.simplified", refuse)
    with pytest.raises(MeshError, match="too large"):
        MeshPart.of(ball(1))
