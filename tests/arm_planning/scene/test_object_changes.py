import math
from dataclasses import replace

import numpy as np
import pytest
from planning_scenes import CUBE, LINKS, SCENE, add, at

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.object_changes import ObjectChange, Operation, change_object
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh

BOX = CollisionObject("box", at(1), (CUBE,), {"top": at(z=0.1)}, ("key", "db"))
WITH_BOX = replace(
    SCENE,
    objects={"box": BOX, "other": CollisionObject("other", at(2), (CUBE,))},
    colors={"box": (1, 0, 0, 1), "other": (0, 1, 0, 1)},
    allowed=AllowedCollisions({("arm", "box"): True, ("arm", "base"): True}, {"box": True}),
)
BALL = PlacedShape(Sphere(0.2), at(z=1))
SQUARE = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0)])


def changed(scene: PlanningScene, change: ObjectChange) -> PlanningScene:
    return change_object(scene, LINKS, change)


def refusal(scene: PlanningScene, change: ObjectChange) -> str:
    with pytest.raises(PlanningError) as caught:
        changed(scene, change)
    assert caught.value.code is MoveItErrorCode.INVALID_OBJECT_NAME
    return str(caught.value)


def test_an_object_is_added_in_the_planning_frame():
    scene = changed(SCENE, add("box", at(1), subframes={"top": at(z=0.1)}, type=("key", "db")))
    assert scene.objects == {"box": BOX}
    assert not SCENE.objects


def test_an_object_is_placed_in_the_frame_that_it_names():
    scene = changed(SCENE, add("box", at(y=1), frame="hand"))
    assert scene.objects["box"].pose == at(1.5, 1, 1)


def test_an_object_of_the_same_name_is_replaced():
    scene = changed(WITH_BOX, add("box", at(3)))
    assert scene.objects["box"] == CollisionObject("box", at(3), (CUBE,))


def test_an_object_of_one_shape_without_a_pose_stands_where_its_shape_stands():
    box = changed(SCENE, add("box", shapes=(BALL,))).objects["box"]
    assert (box.pose, box.shapes) == (at(z=1), (PlacedShape(Sphere(0.2)),))


@pytest.mark.parametrize("pose", [at(1), RigidTransform(rotation=(0, 0, 0, -1))])
def test_a_pose_of_its_own_stays(pose):
    box = changed(SCENE, add("box", pose, shapes=(BALL,))).objects["box"]
    assert (box.pose, box.shapes) == (pose, (BALL,))


def test_shapes_are_appended_where_the_change_places_them():
    change = add("box", at(z=3), shapes=(BALL,), subframes={"pole": at(z=1)})
    scene = changed(WITH_BOX, replace(change, operation=Operation.APPEND))
    box = scene.objects["box"]
    assert (box.pose, box.type) == (BOX.pose, BOX.type)
    assert box.shapes == (CUBE, PlacedShape(Sphere(0.2), at(-1, 0, 4)))
    assert box.subframes == {"top": at(z=0.1), "pole": at(-1, 0, 4)}


def test_appending_to_what_does_not_exist_adds_it():
    change = replace(add("new", at(1)), operation=Operation.APPEND)
    assert changed(SCENE, change).objects["new"].pose == at(1)


def test_an_object_moves():
    change = ObjectChange(Operation.MOVE, "box", "hand", at(1), shape_poses=(at(z=2),))
    box = changed(WITH_BOX, change).objects["box"]
    shapes = (PlacedShape(CUBE.shape, at(z=2)),)
    assert box == replace(BOX, pose=at(2.5, 0, 1), shapes=shapes)


def test_a_removed_object_takes_its_colour_and_its_pairs_with_it():
    scene = changed(WITH_BOX, ObjectChange(Operation.REMOVE, "box"))
    assert scene.objects.keys() == scene.colors.keys() == {"other"}
    assert scene.allowed == AllowedCollisions({("arm", "base"): True})


def test_removing_without_a_name_removes_all():
    scene = changed(WITH_BOX, ObjectChange(Operation.REMOVE, ""))
    assert not scene.objects
    assert not scene.colors


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            ObjectChange(Operation.MOVE, "bxo"),
            "World object 'bxo' does not exist. Cannot move; did you mean 'box'?",
        ),
        (
            ObjectChange(Operation.REMOVE, "qqq"),
            "World object 'qqq' does not exist. Cannot remove; the world has box, other",
        ),
        (
            ObjectChange(Operation.MOVE, "box", shape_poses=(at(), at())),
            "object 'box' has 1 shapes, but 2 poses are given for them",
        ),
        (add("x", shapes=()), "object 'x' has no shapes; give it a primitive, a mesh or a plane"),
        (add(""), "an object has no name; give it an id"),
        (
            add("<octomap>"),
            "the name '<octomap>' is kept for the octomap; give the object another id",
        ),
        (add("hand"), "the robot has a link 'hand'; give the object another id"),
        (add("x", at(math.nan)), "the position of object 'x' is not finite: nan, 0, 0"),
        (
            add("x", RigidTransform(rotation=(0, 0, 0, 0))),
            "the orientation of object 'x' is no unit quaternion: its norm is 0; no rotation is "
            "(0, 0, 0, 1)",
        ),
        (
            add("x", subframes={"top": at(math.inf)}),
            "the position of the subframe 'top' of object 'x' is not finite: inf, 0, 0",
        ),
        (
            add("x", shapes=(PlacedShape(CUBE.shape, at(math.nan)),)),
            "the position of a shape of object 'x' is not finite: nan, 0, 0",
        ),
        (add("x", at(-1e7)), "the position of object 'x' is beyond 1e+06 m: -1e+07, 0, 0"),
        (
            ObjectChange(Operation.MOVE, "box", pose=at(math.nan)),
            "the position of object 'box' is not finite: nan, 0, 0",
        ),
    ],
)
def test_what_is_not_possible_is_refused(change, sentence):
    assert refusal(WITH_BOX, change) == sentence


@pytest.mark.parametrize(
    ("shape", "problem"),
    [
        (Box((1, 0, 1)), "box with a size that is not positive: 1, 0, 1"),
        (Sphere(math.nan), "sphere with a size that is not positive: nan"),
        (Cylinder(1, -2), "cylinder with a size that is not positive: -2, 1"),
        (Cone(math.inf, 2), "cone with a size that is not positive: 2, inf"),
        (Plane(0, 0, 0, 1), "plane without a normal: 0, 0, 0, 1"),
        (Sphere(1e7), "sphere with a size below 1e-06 m or above 1e+06 m: 1e+07"),
        (Box((1, 1e-9, 1)), "box with a size below 1e-06 m or above 1e+06 m: 1, 1e-09, 1"),
        (
            Plane(0, 0, 1e-300, 1),
            "plane that is too far away, or whose normal's length is far from 1: 0, 0, 1e-300, 1",
        ),
        (
            Plane(0, 0, 1, 1e300),
            "plane that is too far away, or whose normal's length is far from 1: 0, 0, 1, 1e+300",
        ),
        (TriangleMesh(SQUARE * 1e7, np.array([(0, 1, 2)])), "mesh with a vertex beyond 1e+06 m"),
        (TriangleMesh(SQUARE, np.array([(0, 1, 1)])), "mesh whose triangles have hardly any area"),
        (TriangleMesh(SQUARE, np.zeros((0, 3), int)), "mesh without triangles"),
        (
            TriangleMesh(SQUARE, np.array([(0, 1, 3)])),
            "mesh with 3 vertices, of which a triangle uses number 3",
        ),
        (
            TriangleMesh(SQUARE, np.array([(0, 1, -1)])),
            "mesh with 3 vertices, of which a triangle uses number -1",
        ),
        (
            TriangleMesh(SQUARE * math.nan, np.array([(0, 1, 2)])),
            "mesh with a vertex that is not finite",
        ),
        (
            TriangleMesh(SQUARE[:, :2].copy(), np.array([(0, 1, 2)])),
            "mesh whose vertices have the shape (3, 2), not (n, 3)",
        ),
    ],
)
def test_a_broken_shape_is_refused(shape, problem):
    assert refusal(SCENE, add("x", shapes=(PlacedShape(shape),))) == f"object 'x' has a {problem}"


def test_an_unknown_frame_is_refused():
    with pytest.raises(PlanningError, match="Unknown frame: nowhere") as caught:
        changed(SCENE, add("x", frame="nowhere"))
    assert caught.value.code is MoveItErrorCode.FRAME_TRANSFORM_FAILURE


def test_what_is_attached_is_detached_first():
    attached = replace(SCENE, attached={"box": AttachedBody(BOX, "hand")})
    assert refusal(attached, add("box")).startswith("object 'box' is attached to link 'hand'")
    for operation in (Operation.MOVE, Operation.REMOVE):
        sentence = refusal(attached, ObjectChange(operation, "box"))
        assert sentence.endswith("it is attached to link 'hand', detach it first")
