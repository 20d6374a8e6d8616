"""What holds after any sequence of changes, and what a change and its opposite give."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planning_scenes import CUBE, MODEL, SCENE

from arm_description.urdf.robot import Box, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.attached_changes import AttachedChange
from arm_planning.scene.frames import LinkPoses, frame_names, frame_pose
from arm_planning.scene.object_changes import ObjectChange, Operation, explicit_pose
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import FixedTransform, SceneChange, change_scene

NAMES = st.sampled_from([*"aaabbbcccddd", "", "hand", "a/top"])
FRAMES = st.sampled_from(["", "", "", "hand", "a", "b/top", "camera", "nowhere"])
LENGTHS = st.floats(-2.0, 2.0)
TURNS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: math.hypot(*q) > 0.1)


def unit(q: tuple[float, ...]) -> RigidTransform:
    norm = math.hypot(*q)
    x, y, z, w = (number / norm for number in q)
    return RigidTransform(rotation=(x, y, z, w))


GOOD_POSES = st.builds(
    lambda xyz, turn: replace(turn, position=xyz),
    st.tuples(LENGTHS, LENGTHS, LENGTHS),
    st.one_of(TURNS.map(unit), st.just(RigidTransform())),
)
# One in twenty is not a pose; hypothesis weighs the strategies of `one_of` alike.
POSES = st.builds(
    lambda number, pose: replace(pose, position=(0.0, math.nan, 0.0)) if number == 13 else pose,
    st.integers(0, 19),
    GOOD_POSES,
)
SHAPES = st.builds(
    PlacedShape, st.sampled_from([*[CUBE.shape, Sphere(0.2)] * 5, Box((1.0, 0.0, 1.0))]), POSES
)
ADD, REMOVE, APPEND, MOVE = Operation
OPERATIONS = st.sampled_from([ADD, ADD, ADD, APPEND, REMOVE, MOVE])
SUBFRAMES = st.dictionaries(st.just("top"), POSES, max_size=1)
CHANGES = st.builds(
    ObjectChange,
    OPERATIONS,
    NAMES,
    FRAMES,
    POSES,
    st.lists(SHAPES, min_size=1, max_size=2).map(tuple),
    SUBFRAMES,
)
ATTACHED = st.builds(
    AttachedChange,
    CHANGES | st.builds(ObjectChange, OPERATIONS, NAMES, subframes=SUBFRAMES),
    st.sampled_from(["hand", "arm", "hand", "arm", "", "qqq"]),
    st.lists(st.sampled_from(["hand", "a", "qqq"]), max_size=2).map(tuple),
)
SCENES = st.builds(
    SceneChange,
    is_diff=st.sampled_from([True] * 5 + [False]),
    is_state_diff=st.booleans(),
    positions=st.dictionaries(
        st.sampled_from(["turn", "slide", "turn", "slide", "knee"]), LENGTHS, max_size=2
    ),
    attached=st.lists(ATTACHED, max_size=2).map(tuple),
    objects=st.lists(CHANGES, min_size=1, max_size=3).map(tuple),
    transforms=st.dictionaries(
        st.just("camera"), st.builds(FixedTransform, FRAMES, POSES), max_size=1
    ),
)


def after(scene: PlanningScene, change: SceneChange) -> PlanningScene:
    return change_scene(MODEL, scene, change, lambda _: None).scene


def bodies(scene: PlanningScene) -> list[CollisionObject]:
    return [*scene.objects.values(), *(body.object for body in scene.attached.values())]


def place(scene: PlanningScene, frame: str) -> np.ndarray:
    links = LinkPoses(MODEL, scene.positions)
    return np.array(frame_pose(scene, links, frame).matrix())


def rebuilt(scene: PlanningScene) -> SceneChange:
    """Return the full scene as a client sends it back."""
    objects = {body.id: add_again(body) for body in bodies(scene)}
    return SceneChange(
        is_diff=False,
        name=scene.name,
        is_state_diff=False,
        positions=scene.positions,
        attached=tuple(
            AttachedChange(
                replace(objects[name], frame=body.link), body.link, tuple(body.touch_links)
            )
            for name, body in scene.attached.items()
        ),
        objects=tuple(objects[name] for name in scene.objects),
        transforms={name: FixedTransform("", pose) for name, pose in scene.transforms.items()},
        allowed=scene.allowed,
        padding=scene.padding,
        scale=scene.scale,
        colors=scene.colors,
    )


def add_again(body: CollisionObject) -> ObjectChange:
    pose, subframes = explicit_pose(body), dict(body.subframes)
    return ObjectChange(ADD, body.id, "", pose, body.shapes, subframes, body.type)


@given(st.lists(SCENES, min_size=1, max_size=3))
def test_each_scene_is_usable(changes):
    scene = SCENE
    for change in changes:
        scene = after(scene, change)
        assert scene.objects.keys().isdisjoint(scene.attached)
        assert all(name == each.id and each.shapes for name, each in scene.objects.items())
        assert {body.link for body in scene.attached.values()} <= {"hand", "arm"}
        assert all(map(math.isfinite, scene.positions.values()))
        for frame in frame_names(scene, LinkPoses(MODEL, scene.positions)):
            pose = place(scene, frame)
            assert np.isfinite(pose).all()
            assert pose[:3, :3] @ pose[:3, :3].T == pytest.approx(np.eye(3), abs=1e-9)


@given(st.lists(SCENES, min_size=1, max_size=3), CHANGES | ATTACHED)
def test_what_fails_changes_nothing(changes, last):
    scene = SCENE
    for change in changes:
        scene = after(scene, change)
    step = (
        SceneChange(attached=(last,))
        if isinstance(last, AttachedChange)
        else SceneChange(objects=(last,))
    )
    outcome = change_scene(MODEL, scene, step, lambda _: None)
    if outcome.problems:
        assert outcome.scene == scene


@given(st.lists(SCENES, min_size=1, max_size=3))
def test_a_whole_scene_comes_back_as_it_was(changes):
    scene = SCENE
    for change in changes:
        scene = after(scene, change)
    outcome = change_scene(MODEL, SCENE, rebuilt(scene), lambda _: None)
    assert not outcome.problems
    again = outcome.scene
    assert again.positions == scene.positions
    assert again.objects.keys() == scene.objects.keys()
    assert again.attached.keys() == scene.attached.keys()
    assert (again.allowed, again.colors) == (scene.allowed, scene.colors)
    for body, other in zip(bodies(scene), bodies(again), strict=True):
        assert (other.shapes, other.subframes, other.type) == (
            body.shapes,
            body.subframes,
            body.type,
        )
    for frame in frame_names(scene, LinkPoses(MODEL, scene.positions)):
        assert place(again, frame) == pytest.approx(place(scene, frame), abs=1e-9)


@given(st.lists(SCENES, min_size=1, max_size=3))
def test_an_object_that_is_attached_and_detached_stays_where_it_is(changes):
    scene = SCENE
    for change in changes:
        scene = after(scene, change)
    for name in scene.objects:
        held = after(
            scene, SceneChange(attached=(AttachedChange(ObjectChange(ADD, name), "hand"),))
        )
        assert place(held, name) == pytest.approx(place(scene, name), abs=1e-9)
        freed = after(held, SceneChange(attached=(AttachedChange(ObjectChange(REMOVE, name)),)))
        assert place(freed, name) == pytest.approx(place(scene, name), abs=1e-9)
        assert freed.objects.keys() == scene.objects.keys()
