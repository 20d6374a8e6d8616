"""Meshes that collision checks cannot use do not stay in the scene."""

from dataclasses import replace

import numpy as np
import pytest
from planar_robot import planar_model

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.ros.scene_monitor import without_unusable
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh

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


def test_meshes_that_can_be_used_stay(before: PlanningScene):
    assert without_unusable(MODEL, EMPTY, before, MeshPieces()) == (before, [])


def test_of_a_change_only_what_cannot_be_used_is_left_out(before: PlanningScene):
    other = thing("other", CORNERS * 2.0)
    after = replace(before, objects={"good": GOOD, "bad": BAD, "other": other})
    kept, (problem,) = without_unusable(MODEL, before, after, MeshPieces())
    assert list(kept.objects) == ["good", "other"]
    assert "bad" in str(problem)


def test_an_object_whose_new_mesh_cannot_be_used_keeps_the_one_it_had(before: PlanningScene):
    after = replace(before, objects={"good": replace(BAD, id="good")})
    kept, problems = without_unusable(MODEL, before, after, MeshPieces())
    assert kept.objects == {"good": GOOD}
    assert len(problems) == 1


def test_an_attached_mesh_that_cannot_be_used_is_left_out(before: PlanningScene):
    after = replace(before, attached={"bad": AttachedBody(BAD, "tip")})
    kept, problems = without_unusable(MODEL, before, after, MeshPieces())
    assert not kept.attached
    assert len(problems) == 1
