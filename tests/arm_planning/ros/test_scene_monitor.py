"""The world's shapes are objects of the scene; meshes that checks cannot use do not stay in it."""

from dataclasses import replace

import numpy as np
import pytest
from geometry_msgs.msg import Point, Vector3
from planar_robot import planar_model
from visualization_msgs.msg import Marker

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.ros.scene_monitor import solids_of, without_unusable
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh
from arm_planning.scene.world_things import followed, objects_of_solids

MODEL = planar_model()
EMPTY = PlanningScene({"shoulder": 0.0, "elbow": 0.0})
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def thing(name: str, vertices: np.ndarray) -> CollisionObject:
    shape = PlacedShape(TriangleMesh(vertices, FACES))
    return CollisionObject(name, RigidTransform((2.0, 2.0, 0.0)), (shape,))


GOOD = thing("good", CORNERS)
# A solid of 10 mm, far away: in single precision, all of it is at one place.
BAD = thing("bad", CORNERS * 0.01 + 9e5)


@pytest.fixture
def before() -> PlanningScene:
    return replace(EMPTY, objects={"good": GOOD})


RAISED = RigidTransform((0.0, 0.0, -0.5))


def marker(kind: int, number: int = 0, name: str = "thing", x: float = 0.0) -> Marker:
    message = Marker(ns=name, id=number, type=kind, scale=Vector3(x=0.2, y=0.2, z=0.6))
    message.pose.position.x = x
    return message


def objects_of(markers: list[Marker], world: RigidTransform) -> dict[str, CollisionObject]:
    return objects_of_solids(solids_of(markers), world)


def test_meshes_that_can_be_used_stay(before):
    assert without_unusable(MODEL, EMPTY, before, MeshPieces()) == (before, [])


def test_of_a_change_only_what_cannot_be_used_is_left_out(before):
    other = thing("other", CORNERS * 2.0)
    after = replace(before, objects={"good": GOOD, "bad": BAD, "other": other})
    kept, (problem,) = without_unusable(MODEL, before, after, MeshPieces())
    assert list(kept.objects) == ["good", "other"]
    assert "bad" in str(problem)


def test_an_object_whose_new_mesh_cannot_be_used_keeps_the_one_it_had(before):
    after = replace(before, objects={"good": replace(BAD, id="good")})
    kept, problems = without_unusable(MODEL, before, after, MeshPieces())
    assert kept.objects == {"good": GOOD}
    assert len(problems) == 1


def test_an_attached_mesh_that_cannot_be_used_is_left_out(before):
    after = replace(before, attached={"bad": AttachedBody(BAD, "tip")})
    kept, problems = without_unusable(MODEL, before, after, MeshPieces())
    assert not kept.attached
    assert len(problems) == 1


def test_shapes_of_one_name_are_one_object_where_its_first_shape_stands():
    made = objects_of([marker(Marker.CUBE, 0, x=1.0), marker(Marker.CYLINDER, 1, x=1.5)], RAISED)
    thing = made["thing"]
    assert thing.pose.position == (1.0, 0.0, -0.5)
    box, cylinder = thing.shapes
    assert (box.shape, box.pose) == (Box((0.2, 0.2, 0.6)), RigidTransform())
    assert (cylinder.shape, cylinder.pose.position) == (Cylinder(0.1, 0.6), (0.5, 0.0, 0.0))


def test_an_ellipsoid_is_the_ball_about_it():
    made = objects_of([marker(Marker.SPHERE)], RAISED)
    assert made["thing"].shapes[0].shape == Sphere(0.3)


def test_triangles_share_their_corners_and_flat_ones_are_left_out():
    message = marker(Marker.TRIANGLE_LIST)
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 0)]
    corners += [(0, 0, 0), (1, 1, 0)]
    message.points = [Point(x=float(x), y=float(y), z=float(z)) for x, y, z in corners]
    shape = objects_of([message], RAISED)["thing"].shapes[0].shape
    assert isinstance(shape, TriangleMesh)
    assert shape.vertices.shape == (4, 3)
    assert shape.triangles.shape == (2, 3)
    assert np.isclose(shape.vertices[shape.triangles[1]].sum(axis=0), (2.0, 2.0, 0.0)).all()


def test_what_has_no_solid_shape_is_left_out():
    assert objects_of([marker(Marker.TEXT_VIEW_FACING), marker(Marker.TRIANGLE_LIST)], RAISED) == {}


def test_a_thing_called_as_a_link_gets_an_underscore():
    solids = solids_of([marker(Marker.CUBE, name="world"), marker(Marker.CUBE, name="can")])
    assert set(objects_of_solids(solids, RAISED, ["base", "world"])) == {"world_", "can"}


def test_what_was_attached_follows_the_world_again_once_it_is_detached():
    here, there = (objects_of([marker(Marker.CUBE, x=x)], RAISED) for x in (0.0, 1.0))
    scene = followed(PlanningScene({}), {}, here)
    held = replace(scene, objects={}, attached={"thing": AttachedBody(here["thing"], "hand")})
    assert not followed(held, here, there).objects
    let_go = replace(held, objects=dict(here), attached={})
    assert followed(let_go, there, there).objects == there


def test_other_objects_stay_and_what_has_gone_from_the_world_goes():
    things, own = (objects_of([marker(Marker.CUBE, name=name)], RAISED) for name in ("can", "own"))
    scene = followed(PlanningScene({}, own), {}, things)
    assert set(scene.objects) == {"can", "own"}
    assert followed(scene, things, {}).objects == own
