from dataclasses import replace

import pytest
from planning_scenes import CUBE, LINKS, SCENE, add, at

from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.scene.attached_changes import AttachedChange, change_attached
from arm_planning.scene.object_changes import ObjectChange, Operation
from arm_planning.scene.objects import AttachedBody, CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Plane

BOX = CollisionObject("box", at(1), (CUBE,), {"top": at(z=0.1)}, ("key", "db"))
WORLD = replace(SCENE, objects={"box": BOX}, colors={"box": (1, 0, 0, 1)})
GRASP = AttachedChange(ObjectChange(Operation.ADD, "box"), "hand", ("hand", "finger"))
HELD = change_attached(WORLD, LINKS, GRASP)


def changed(scene: PlanningScene, change: AttachedChange) -> PlanningScene:
    return change_attached(scene, LINKS, change)


def let_go(name: str = "", link: str = "") -> AttachedChange:
    return AttachedChange(ObjectChange(Operation.REMOVE, name), link)


def test_an_object_of_the_world_is_attached_where_it_is():
    box = replace(BOX, pose=at(-0.5, 0, -1))
    touching = frozenset({"hand", "finger"})
    assert HELD.attached == {"box": AttachedBody(box, "hand", touching)}
    assert not HELD.objects
    assert HELD.colors == WORLD.colors


def test_shapes_that_are_given_take_the_place_of_the_worlds_object():
    scene = changed(WORLD, AttachedChange(add("box", at(z=1), frame="hand"), "hand"))
    assert scene.attached["box"].object == CollisionObject("box", at(z=1), (CUBE,))
    assert not scene.objects


def test_subframes_that_are_given_are_added():
    given = ObjectChange(Operation.ADD, "box", subframes={"side": at(y=1)})
    scene = changed(WORLD, AttachedChange(given, "hand"))
    assert scene.attached["box"].object.subframes == {"top": at(z=0.1), "side": at(y=1)}


def test_attaching_again_replaces():
    scene = changed(HELD, AttachedChange(add("box", frame="arm"), "arm"))
    assert scene.attached == {"box": AttachedBody(CollisionObject("box", at(), (CUBE,)), "arm")}


def test_an_object_may_be_attached_again_in_its_own_frame():
    scene = changed(HELD, AttachedChange(add("box", at(z=1), frame="box"), "hand"))
    assert scene.attached["box"].object.pose == at(-0.5, 0, 0)


def test_appended_shapes_and_touch_links_join_those_before():
    change = replace(add("box", at(z=1), frame="hand"), operation=Operation.APPEND)
    body = changed(HELD, AttachedChange(change, "hand", ("arm",))).attached["box"]
    assert body.object.pose == at(-0.5, 0, -1)
    assert body.object.shapes == (CUBE, PlacedShape(CUBE.shape, at(0.5, 0, 2)))
    assert body.touch_links == {"hand", "finger", "arm"}


@pytest.mark.parametrize("change", [let_go("box"), let_go("box", "hand"), let_go(link="hand")])
def test_a_detached_object_is_in_the_world_where_the_hand_left_it(change):
    assert changed(HELD, change) == WORLD


def test_detaching_without_names_detaches_all():
    both = changed(HELD, AttachedChange(add("lamp", frame="arm"), "arm"))
    assert changed(both, let_go()).objects.keys() == {"box", "lamp"}
    assert changed(both, let_go(link="arm")).attached.keys() == {"box"}


@pytest.mark.parametrize(
    ("scene", "change", "code", "sentence"),
    [
        (
            WORLD,
            replace(GRASP, link="hnad"),
            MoveItErrorCode.INVALID_LINK_NAME,
            "no link 'hnad'; did you mean 'hand'?",
        ),
        (
            WORLD,
            replace(GRASP, link="odom"),
            MoveItErrorCode.INVALID_LINK_NAME,
            "no link 'odom'; the robot has arm, base, finger, hand",
        ),
        (
            SCENE,
            GRASP,
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "Attempting to attach object 'box' to link 'hand' but no geometry specified and such "
            "an object does not exist in the collision world; the world has none",
        ),
        (
            WORLD,
            let_go("box"),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "object 'box' is not attached; the robot holds none",
        ),
        (
            HELD,
            let_go("box", "arm"),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "object 'box' is attached to link 'hand', not to 'arm'",
        ),
        (
            HELD,
            let_go(link="x"),
            MoveItErrorCode.INVALID_LINK_NAME,
            "no link 'x'; the robot has arm, base, finger, hand",
        ),
        (
            HELD,
            AttachedChange(ObjectChange(Operation.MOVE, "box"), "hand"),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "object 'box' is attached and cannot be moved; attach it again at its new pose",
        ),
        (
            SCENE,
            AttachedChange(add("arm"), "hand"),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "the robot has a link 'arm'; give the object another id",
        ),
    ],
)
def test_what_is_not_possible_is_refused(scene, change, code, sentence):
    with pytest.raises(PlanningError) as caught:
        changed(scene, change)
    assert (caught.value.code, str(caught.value)) == (code, sentence)


def test_a_plane_cannot_be_attached():
    change = AttachedChange(add("floor", shapes=(PlacedShape(Plane(0, 0, 1, 0)),)), "hand")
    with pytest.raises(PlanningError, match="'floor' has a plane, which cannot be attached"):
        changed(SCENE, change)
