"""Shapes as triangles."""

import numpy as np
import pytest

from arm_description.errors import DescriptionError
from arm_description.robot import Box, Capsule, Cylinder, Mesh, Sphere
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
