"""Distances of points from the shapes of regions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.regions import distance_outside, local_point
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh

CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
CUBE = TriangleMesh(
    CORNERS.copy(), np.array([t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d))])
)
SHAPES = {
    "box": (Box((2.0, 4.0, 6.0)), [4.0, 6.0, 3.0], 5.0),
    "sphere": (Sphere(2.0), [0.0, 3.0, 4.0], 3.0),
    "beside a cylinder": (Cylinder(1.0, 2.0), [3.0, 4.0, 0.5], 4.0),
    "past a cylinder's edge": (Cylinder(2.0, 2.0), [0.0, 5.0, 5.0], 5.0),
    "above a cone": (Cone(1.0, 2.0), [0.0, 0.0, 4.0], 3.0),
    "below a cone": (Cone(1.0, 2.0), [0.5, 0.0, -2.0], 1.0),
    "beside a cone": (Cone(3.0, 4.0), [0.0, 4.0 + 1.5, 0.0 + 3.0], 5.0),
    "above a plane": (Plane(0.0, 0.0, 2.0, -2.0), [9.0, 9.0, 4.0], 3.0),
    "past a mesh's face": (CUBE, [0.3, 0.2, 3.0], 2.0),
    "past a mesh's corner": (CUBE, [2.0, 3.0, 3.0], 3.0),
}


@pytest.mark.parametrize("case", SHAPES)
def test_a_point_outside_has_its_distance(case):
    shape, point, distance = SHAPES[case]
    assert distance_outside(shape, np.array(point)) == pytest.approx(distance)


@pytest.mark.parametrize("case", SHAPES)
def test_a_point_inside_has_no_distance(case):
    assert distance_outside(SHAPES[case][0], np.array([0.1, -0.05, -0.2])) == 0.0


def test_a_mesh_is_a_volume_whichever_way_its_surface_faces():
    inward = TriangleMesh(CUBE.vertices.copy(), CUBE.triangles[:, ::-1].copy())
    assert distance_outside(inward, np.array([0.9, 0.9, -0.9])) == 0.0


def test_the_notch_of_a_mesh_is_outside():
    frame = np.array([[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]], dtype=float)
    low = np.column_stack([frame, np.zeros(8)])
    cap = [(0, 1, 4), (0, 4, 5), (1, 2, 4), (2, 3, 4), (0, 5, 7), (5, 6, 7)]
    sides = [
        t
        for i in range(8)
        for t in ((i, (i + 1) % 8, i + 8), ((i + 1) % 8, (i + 1) % 8 + 8, i + 8))
    ]
    triangles = [t[::-1] for t in cap] + [tuple(i + 8 for i in t) for t in cap] + sides
    notched = TriangleMesh(np.vstack([low, low + np.array([0, 0, 1])]), np.array(triangles))
    assert distance_outside(notched, np.array([0.5, 2.5, 0.5])) == 0.0
    assert distance_outside(notched, np.array([1.5, 2.0, 0.5])) == pytest.approx(0.5)


coordinate = st.floats(-4.0, 4.0)


@given(st.tuples(coordinate, coordinate, coordinate))
def test_a_mesh_of_a_box_measures_as_the_box(point):
    box = distance_outside(Box((2.0, 2.0, 2.0)), np.array(point))
    assert distance_outside(CUBE, np.array(point)) == pytest.approx(box, abs=1e-6)


@given(st.tuples(coordinate, coordinate, coordinate))
def test_a_cone_is_as_far_as_its_nearest_point(point):
    cone = Cone(1.5, 3.0)
    radius, height = np.meshgrid(np.linspace(0, 1.5, 61), np.linspace(-1.5, 1.5, 121))
    inside = radius / 1.5 + (height + 1.5) / 3.0 <= 1.0 + 1e-12
    radial = np.hypot(point[0], point[1])
    nearest = np.hypot(radius[inside] - radial, height[inside] - point[2]).min()
    assert distance_outside(cone, np.array(point)) == pytest.approx(nearest, abs=0.03)


def test_a_region_is_placed():
    quarter = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
    region = PlacedShape(Box((1.0, 1.0, 1.0)), RigidTransform((1.0, 0.0, 0.0), quarter))
    assert local_point(region, np.array([1.0, 2.0, 0.5])) == pytest.approx([2.0, 0.0, 0.5])
