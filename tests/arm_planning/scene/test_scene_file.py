from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planning_scenes import CUBE, LINKS, SCENE, add, at

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.scene.object_changes import change_object
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_file import scene_text, with_scene_file
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh

FILE = """kitchen table
* big box
0.5 0 0.25
0 0 0 1
1
box
0.2 0.05 0.5
0 0 0
0 0 0.6 0.8
1 0 0 0.5
1
top
0 0 0.25
0 0 0 1
* ball
0 0 0
0 0 0 1
2
sphere
0.1
1 0 0
0 0 0 1
0 0 0 0
cylinder
0.1 0.4
0 0 0
0 0 0 1
0 0 0 0
0
.
"""
OLD = "(noname)\n* box\n1\nbox\n1 2 3\n0 0 1\n0 0 0 1\n0 0 0 0\n.\n"
SHAPE_NAMES = "there are sphere, box, cylinder, cone, plane, mesh"
MESH = TriangleMesh(np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 1)]), np.array([(0, 1, 2)]))
SHAPES = [Sphere(0.3), Box((1, 2, 3)), Cylinder(0.1, 2), Cone(0.2, 3), Plane(0, 0, 1, 0.5)]


def read(text: str, scene: PlanningScene = SCENE) -> PlanningScene:
    return with_scene_file(scene, LINKS, text, "x.scene")


def test_a_file_is_read():
    scene = read(FILE, change_object(SCENE, LINKS, add("lamp")))
    assert scene.name == "kitchen table"
    assert scene.objects.keys() == {"lamp", "big box", "ball"}
    box, ball = scene.objects["big box"], scene.objects["ball"]
    turned = RigidTransform(rotation=(0, 0, 0.6, 0.8))
    assert box.pose == at(0.5, 0, 0.25)
    assert box.shapes == (PlacedShape(Box((0.2, 0.05, 0.5)), turned),)
    assert box.subframes == {"top": at(z=0.25)}
    assert ball.shapes == (PlacedShape(Sphere(0.1), at(1)), PlacedShape(Cylinder(0.1, 0.4)))
    assert scene.colors == {"big box": (1, 0, 0, 0.5)}


def test_a_file_of_the_old_format_is_read():
    box = read(OLD).objects["box"]
    assert [placed.pose for placed in box.shapes] == [at(z=1)]


POSES = st.builds(
    lambda xyz, turned: RigidTransform(xyz, (0.6, 0.0, 0.0, 0.8) if turned else (0, 0, 0, 1.0)),
    st.tuples(*[st.floats(-1e3, 1e3)] * 3),
    st.booleans(),
)
PLACED = st.builds(PlacedShape, st.sampled_from(SHAPES), POSES)
OBJECTS = st.builds(
    lambda pose, shapes, subframes: add("x y", pose, shapes=tuple(shapes), subframes=subframes),
    POSES,
    st.lists(PLACED, min_size=1, max_size=3),
    st.dictionaries(st.sampled_from(["top", "a/b"]), POSES),
)


@given(OBJECTS, st.booleans())
def test_what_is_written_is_read_again(change, has_color):
    scene = change_object(SCENE, LINKS, change)
    if has_color:
        scene = replace(scene, colors={"x y": (0.1, 0.2, 0.3, 1.0)})
    again = read(scene_text(scene))
    known = again.objects["x y"]
    if known.pose.rotation == (0.0, 0.0, 0.0, -1.0):
        known = replace(known, pose=RigidTransform(known.pose.position))
    assert replace(again, objects={"x y": known}) == scene


def test_a_mesh_is_read_again():
    scene = change_object(SCENE, LINKS, add("m", shapes=(PlacedShape(MESH), CUBE)))
    mesh = read(scene_text(scene)).objects["m"].shapes[0].shape
    assert isinstance(mesh, TriangleMesh)
    assert (mesh.vertices == MESH.vertices).all()
    assert (mesh.triangles == MESH.triangles).all()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "line 1: the file ends where '*' or '.' should be"),
        ("name\n", "line 2: the file ends where '*' or '.' should be"),
        ("name\nbox", "line 2: 'box' is neither '*', which starts an object, nor '.'"),
        (FILE.replace("0.2 0.05 0.5", "0.2 wide 0.5"), "line 7: 'wide' is not a side of a box"),
        (FILE.replace("0.2 0.05 0.5", "0.2 nan 0.5"), "line 7: 'nan' is not a side of a box"),
        (FILE.replace("sphere", "torus"), f"line 19: 'torus' is not a shape; {SHAPE_NAMES}"),
        (
            FILE.replace("\n0.1\n", "\n-0.1\n"),
            "line 29: object 'ball' has a sphere with a size that is not positive: -0.1",
        ),
        (
            FILE.replace("\n1\nbox", "\n99999999999\nbox"),
            "line 5: '99999999999' is not a number of shapes",
        ),
        (
            FILE.replace("\n1\nbox", "\n999999999\nbox"),
            f"line 11: '1' is not a shape; {SHAPE_NAMES}",
        ),
        (
            "n\n* m\n1\nmesh\n3 999999999\n0 0 0 0 0 0 0 0 0 0 1 2",
            "line 6: the file ends where the number of a vertex should be",
        ),
        (FILE.replace("big box", ""), "line 14: an object has no name; give it an id"),
    ],
)
def test_a_broken_file_is_refused_with_its_line(text, sentence):
    with pytest.raises(PlanningError) as caught:
        read(text)
    assert str(caught.value) == f"x.scene, {sentence}"


@pytest.mark.parametrize(
    ("change", "part"),
    [(add("a\nb"), "the name 'a\\nb'"), (add("x", subframes={"a b": at()}), "'a b' of a subframe")],
)
def test_names_that_a_file_cannot_hold_are_refused(change, part):
    with pytest.raises(PlanningError, match="cannot hold the name") as caught:
        scene_text(change_object(SCENE, LINKS, change))
    assert part in str(caught.value)
