"""Points on a robot and on the objects of a scene."""

from math import pi

import numpy as np
import pytest
from robots import collision, joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import BodyFilter
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh

ROBOT = parse_urdf(
    robot(
        link("base"),
        link("arm", collision("box", xyz="0.5 0 0", size="1 0.2 0.2")),
        joint("turn", "base", "arm", axis="0 0 1"),
    )
)
MODEL = planning_model(ROBOT, parse_srdf("<robot name='r'/>", ROBOT))
AT = (5.0, 0.0, 0.0)
TETRAHEDRON = TriangleMesh(
    np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


def inside(*points, turn=0.0, scale=1.0, padding_m=0.0, **scene):
    bodies = BodyFilter(MODEL, MeshPieces(), scale, padding_m)
    found = bodies.inside(np.array(points, float), PlanningScene({"turn": turn}, **scene))
    return found.tolist()


def thing(shape, pose=RigidTransform(AT)):
    return {"thing": CollisionObject("thing", pose, (PlacedShape(shape),))}


def test_links_are_where_the_joints_put_them():
    assert inside((0.9, 0.05, 0.0), (0.0, 0.9, 0.0)) == [True, False]
    assert inside((0.9, 0.05, 0.0), (0.0, 0.9, 0.0), turn=pi / 2) == [False, True]


def test_shapes_are_scaled_about_their_middle_and_then_padded():
    points = (1.04, 0.0, 0.0), (1.04, 0.13, 0.0), (1.15, 0.0, 0.0)
    assert inside(*points, padding_m=0.05) == [True, True, False] or False
    assert inside(*points, scale=1.2) == [True, False, False]


@pytest.mark.parametrize(
    ("shape", "within", "without"),
    [
        (Box((0.2, 0.4, 0.6)), (0.09, 0.19, 0.29), (0.11, 0.0, 0.0)),
        (Sphere(0.3), (0.17, 0.17, 0.17), (0.18, 0.18, 0.18)),
        (Cylinder(0.2, 0.6), (0.14, 0.14, 0.29), (0.15, 0.15, 0.0)),
        (Cone(0.2, 0.6), (0.0, 0.0, 0.29), (0.1, 0.0, 0.2)),
        (Plane(0.0, 0.0, 1.0, -0.5), (9.0, 9.0, 0.4), (9.0, 9.0, 0.6)),
        (TETRAHEDRON, (0.2, 0.2, 0.2), (0.5, 0.5, 0.5)),
    ],
)
def test_each_shape_has_its_inside_and_grows_by_the_padding(shape, within, without):
    points = np.array([within, without]) + AT
    assert inside(*points, objects=thing(shape)) == [True, False]
    far = np.array(AT) + 5 * np.array([without[0] or 1, without[1] or 1, without[2] or 1])
    assert inside(far, objects=thing(shape), padding_m=0.001) == [False]
    assert inside(points[1], objects=thing(shape), padding_m=0.5) == [True]


def test_what_is_attached_moves_with_its_link():
    held = thing(Sphere(0.1), RigidTransform((1.5, 0.0, 0.0)))["thing"]
    attached = {"thing": AttachedBody(held, "arm")}
    assert inside((1.5, 0.0, 0.0), (0.0, 1.5, 0.0), turn=pi / 2, attached=attached) == [False, True]
