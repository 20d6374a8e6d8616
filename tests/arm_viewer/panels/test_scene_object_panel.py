"""Objects for the planning scene from what the user has entered."""

import math
from dataclasses import replace

import pytest

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_viewer.panels.scene_object_panel import ObjectFields, new_object
from arm_viewer.world.shape_fields import ObjectKind

FIELDS = ObjectFields(" box1 ", ObjectKind.BOX, "0.1 0.2 0.3", "1, 2, 3", f"0 0 {math.pi}")


def test_it_has_the_name_and_the_pose_that_were_entered():
    made = new_object(FIELDS)
    assert made.id == "box1"
    assert made.pose.position == (1.0, 2.0, 3.0)
    assert made.pose.rotation == pytest.approx((0.0, 0.0, 1.0, 0.0))


@pytest.mark.parametrize(
    ("kind", "size", "shape"),
    [
        (ObjectKind.BOX, "0.1 0.2 0.3", Box((0.1, 0.2, 0.3))),
        (ObjectKind.SPHERE, "0.05", Sphere(0.05)),
        (ObjectKind.CYLINDER, "0.05 0.4", Cylinder(radius=0.05, length=0.4)),
    ],
)
def test_each_kind_takes_the_lengths_that_it_has(kind, size, shape):
    (placed,) = new_object(replace(FIELDS, kind=kind, size=size)).shapes
    assert placed.shape == shape
    new_object(replace(FIELDS, kind=kind, size=kind.example))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"name": "  "}, "The object needs a name."),
        ({"size": "0.1 0 0.3"}, "The size must be greater than 0 m, not 0 m."),
        ({"size": "0.1 0.2"}, "The size is not 'x y z' in numbers: '0.1 0.2'"),
        ({"kind": ObjectKind.SPHERE, "size": "big"}, "The size is not 'radius' in numbers: 'big'"),
        ({"position": "0 0 inf"}, "The position is not 'x y z' in numbers: '0 0 inf'"),
        ({"rpy": ""}, "The orientation is not 'roll pitch yaw' in numbers: ''"),
    ],
)
def test_what_cannot_be_used_is_said_in_a_sentence(wrong, said):
    with pytest.raises(ValueError, match=said):
        new_object(replace(FIELDS, **wrong))
