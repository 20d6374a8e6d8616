"""Shapes as triangles."""

import numpy as np
import pytest

from arm_description.errors import DescriptionError
from arm_description.mesh.data import MeshData
from arm_description.urdf.robot import Box, Capsule, Cylinder, Mesh, Sphere
from arm_viewer.scene.triangles import edges, smooth, triangles


@pytest.mark.parametrize(
    ("shape", "sides"),
    [
        (Box((1.0, 2.0, 3.0)), (1.0, 2.0, 3.0)),
        (Cylinder(0.5, 3.0), (1.0, 1.0, 3.0)),
        (Sphere(0.5), (1.0, 1.0, 1.0)),
        (Capsule(0.5, 2.0), (1.0, 1.0, 3.0)),
    ],
)
def test_shapes_have_their_size_and_are_centred(shape, sides):
    (mesh,) = triangles(shape)
    low, high = mesh.bounds
    assert high - low == pytest.approx(np.array(sides), rel=0.01)
    assert high + low == pytest.approx(np.zeros(3), abs=0.01)


def test_a_mesh_of_a_package_is_found_and_scaled():
    uri = "package://arm_description/meshes/base_link.stl"
    (mesh,), (large,) = triangles(Mesh(uri)), triangles(Mesh(uri, (2.0, 2.0, 2.0)))
    assert np.allclose(large.vertices, 2.0 * mesh.vertices)


def test_a_mesh_that_cannot_be_had_is_named(tmp_path):
    broken = tmp_path / "broken.stl"
    broken.write_bytes(b"no mesh")
    with pytest.raises(DescriptionError, match=r"broken\.stl"):
        triangles(Mesh(str(broken)))
    with pytest.raises(DescriptionError, match=r"gone\.stl"):
        triangles(Mesh(str(tmp_path / "gone.stl")))


def test_a_box_has_twelve_edges_and_no_diagonals():
    (box,) = triangles(Box((1.0, 2.0, 3.0)))
    lengths = np.linalg.norm(np.diff(edges(box), axis=1)[:, 0], axis=1)
    assert sorted(lengths.round(6)) == [1.0] * 4 + [2.0] * 4 + [3.0] * 4


def test_corners_are_parted_at_sharp_edges():
    (box,) = triangles(Box((1.0, 1.0, 1.0)))
    assert len(smooth(box).vertices) == 24
    (ball,) = triangles(Sphere(1.0))
    assert len(smooth(ball).vertices) == len(ball.vertices)


def test_a_cylinder_is_parted_at_its_two_rims_only():
    (cylinder,) = triangles(Cylinder(0.5, 1.0))
    on_rims = np.hypot(*cylinder.vertices[:, :2].T) > 0.1
    assert len(smooth(cylinder).vertices) == len(cylinder.vertices) + np.count_nonzero(on_rims)


def test_a_large_flat_area_is_parted_from_slopes_that_are_not_sharp():
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    rings = [(square, 0.0), (0.9 * square, 0.03)]
    vertices = np.concatenate([np.column_stack([ring, np.full(4, z)]) for ring, z in rings])
    slopes = [[i, (i + 1) % 4, 4 + (i + 1) % 4] for i in range(4)]
    slopes += [[i, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    mesh = MeshData(vertices, np.array([*slopes, [4, 5, 6], [4, 6, 7]], dtype=np.int32))
    # All meet at less than SHARP_RAD; only the four corners of the top are doubled.
    assert len(smooth(mesh).vertices) == len(vertices) + 4


def test_smoothing_moves_no_triangle():
    for shape in (Box((1.0, 1.0, 1.0)), Capsule(0.5, 2.0)):
        (mesh,) = triangles(shape)
        parted = smooth(mesh)
        assert np.array_equal(parted.vertices[parted.faces], mesh.vertices[mesh.faces])
