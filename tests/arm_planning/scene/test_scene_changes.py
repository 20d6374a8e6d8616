import math
from dataclasses import replace

import pytest
from planning_scenes import CUBE, MODEL, SCENE, add, at

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode
from arm_planning.scene.allowed_collisions import AllowedCollisions
from arm_planning.scene.attached_changes import AttachedChange
from arm_planning.scene.object_changes import ObjectChange, Operation
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import FixedTransform, SceneChange, change_scene

BOX = CollisionObject("box", at(1), (CUBE,))
CUP = AttachedBody(CollisionObject("cup", at(), (CUBE,)), "hand")
ALLOWED = AllowedCollisions({("arm", "base"): True})
FULL = replace(
    SCENE,
    objects={"box": BOX},
    attached={"cup": CUP},
    allowed=ALLOWED,
    padding={"arm": 0.01},
    scale={"arm": 1.1},
    transforms={"camera": at(5)},
    colors={"box": (1, 0, 0, 1)},
    name="kitchen",
)
GRASP_CUP = AttachedChange(add("cup", frame="hand"), "hand")


def changed(scene: PlanningScene, change: SceneChange) -> PlanningScene:
    outcome = change_scene(MODEL, scene, change, pytest.fail)
    assert not outcome.problems
    return outcome.scene


def problems(change: SceneChange, scene: PlanningScene = FULL) -> list[tuple[MoveItErrorCode, str]]:
    outcome = change_scene(MODEL, scene, change, pytest.fail)
    assert outcome.scene == scene
    return [(problem.code, str(problem)) for problem in outcome.problems]


def test_a_diff_without_content_changes_nothing():
    assert changed(FULL, SceneChange()) == FULL


def test_a_diff_changes_what_it_names():
    change = SceneChange(
        name="hall",
        positions={"turn": 1.0},
        objects=(add("crate", at(3)), ObjectChange(Operation.REMOVE, "box")),
        attached=(AttachedChange(ObjectChange(Operation.REMOVE, "cup")),),
        transforms={"lamp": FixedTransform("camera", at(z=1))},
        padding={"hand": 0.02},
        scale={"hand": 1.2},
        colors={"crate": (0, 0, 1, 1)},
    )
    scene = changed(FULL, change)
    assert scene.positions == {"turn": 1.0, "slide": 0.5}
    assert scene.objects.keys() == {"crate", "cup"}
    assert not scene.attached
    assert scene.transforms == {"camera": at(5), "lamp": at(5, 0, 1)}
    assert scene.padding == {"arm": 0.01, "hand": 0.02}
    assert scene.scale == {"arm": 1.1, "hand": 1.2}
    assert scene.colors == {"crate": (0, 0, 1, 1)}
    assert (scene.name, scene.allowed) == ("hall", ALLOWED)


def test_a_matrix_replaces_the_whole_one_before():
    matrix = AllowedCollisions({("base", "hand"): True})
    assert changed(FULL, SceneChange(allowed=matrix)).allowed == matrix


def test_a_full_scene_keeps_only_the_robots_state():
    scene = changed(FULL, SceneChange(is_diff=False, objects=(add("crate", at(3)),)))
    assert scene == PlanningScene(
        FULL.positions,
        objects={"crate": CollisionObject("crate", at(3), (CUBE,))},
        attached=FULL.attached,
        name="",
    )


@pytest.mark.parametrize("is_diff", [True, False])
def test_a_full_state_with_positions_starts_without_attached_bodies(is_diff):
    change = SceneChange(is_diff=is_diff, is_state_diff=False, positions={"turn": 1.0})
    assert not changed(FULL, change).attached
    again = changed(FULL, replace(change, attached=(GRASP_CUP,)))
    assert again.attached == {"cup": CUP}


def test_a_full_state_without_positions_changes_nothing():
    assert changed(FULL, SceneChange(is_state_diff=False)) == FULL


def test_what_is_attached_is_placed_by_the_positions_of_the_same_change():
    change = SceneChange(positions={"slide": 2.0}, attached=(AttachedChange(add("b"), "hand"),))
    assert changed(SCENE, change).attached["b"].object.pose == at(-3, 0, -1)


def test_objects_are_changed_in_order():
    steps = (
        add("a", at(1)),
        add("b", at(1), frame="a"),
        ObjectChange(Operation.MOVE, "a", pose=at(5)),
        ObjectChange(Operation.REMOVE, "a"),
        add("a", at(7)),
    )
    scene = changed(SCENE, SceneChange(objects=steps))
    assert {name: each.pose for name, each in scene.objects.items()} == {"b": at(2), "a": at(7)}


def test_a_part_that_fails_leaves_the_others_in_force():
    steps = (add("a"), add("b", at(math.nan)), add("c"))
    outcome = change_scene(MODEL, SCENE, SceneChange(objects=steps), pytest.fail)
    assert outcome.scene.objects.keys() == {"a", "c"}
    assert [str(problem) for problem in outcome.problems] == [
        "the position of object 'b' is not finite: nan, 0, 0"
    ]


@pytest.mark.parametrize(
    ("change", "code", "sentence"),
    [
        (
            SceneChange(positions={"turn": 1.0, "follow": 1.0}),
            MoveItErrorCode.INVALID_ROBOT_STATE,
            "no active joint 'follow'; the robot has slide, turn",
        ),
        (
            SceneChange(positions={"turn": math.nan}, is_state_diff=False),
            MoveItErrorCode.INVALID_ROBOT_STATE,
            "the position of joint 'turn' is nan",
        ),
        (
            SceneChange(padding={"amr": 0.1}),
            MoveItErrorCode.INVALID_LINK_NAME,
            "padding of no link 'amr'; did you mean 'arm'?",
        ),
        (
            SceneChange(padding={"arm": -0.1}),
            MoveItErrorCode.INVALID_LINK_NAME,
            "the padding of link 'arm' is -0.1; it is not negative and at most 1e+06",
        ),
        (
            SceneChange(scale={"arm": 0.0}),
            MoveItErrorCode.INVALID_LINK_NAME,
            "the scale of link 'arm' is 0.0; it is above 0 and at most 1e+06",
        ),
        (
            SceneChange(padding={"arm": 1e308}),
            MoveItErrorCode.INVALID_LINK_NAME,
            "the padding of link 'arm' is 1e+308; it is not negative and at most 1e+06",
        ),
        (
            SceneChange(
                transforms={"f": FixedTransform("", RigidTransform(rotation=(1, 1, 0, 0)))}
            ),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "the orientation of frame 'f' is no unit quaternion: its norm is 1.414; no rotation is "
            "(0, 0, 0, 1)",
        ),
        (
            SceneChange(transforms={"f": FixedTransform("qqq", at())}),
            MoveItErrorCode.FRAME_TRANSFORM_FAILURE,
            "Unknown frame: qqq; the frames are arm, base, box, camera, cup, finger, hand",
        ),
        (
            SceneChange(
                is_state_diff=False,
                attached=(AttachedChange(ObjectChange(Operation.REMOVE, "cup")),),
            ),
            MoveItErrorCode.INVALID_OBJECT_NAME,
            "object 'cup' is to be changed by a robot state that is not a diff, which can only "
            "add; set is_diff of the state",
        ),
    ],
)
def test_what_is_not_possible_leaves_the_scene_as_it_was(change, code, sentence):
    assert problems(change) == [(code, sentence)]


def test_another_robots_scene_is_a_warning():
    warnings: list[str] = []
    change_scene(MODEL, SCENE, SceneChange(robot_name="leg"), warnings.append)
    assert warnings == ["Setting the scene for model 'leg' but model 'r' is loaded."]


def test_touch_links_that_do_not_exist_are_a_warning():
    warnings: list[str] = []
    touching = ("hand", "lid", "qqq")
    steps = (
        replace(GRASP_CUP, touch_links=touching),
        AttachedChange(add("lid", frame="hand"), "hand"),
    )
    change_scene(MODEL, SCENE, SceneChange(attached=steps), warnings.append)
    assert warnings == ["object 'cup' may touch 'qqq', which is neither a link nor attached"]
