"""The list of the world's things, as HTML and in words."""

import pytest

from arm_node.rigid_transform import RigidTransform
from arm_viewer.panels.world_panel import described, listed, properties_of, rows
from arm_viewer.world.shape_fields import read_number
from arm_viewer.world.world_view import Thing, ThingProperties, WorldView

CUBE = Thing(RigidTransform((0.1, -0.2, 0.0255)), 0.123, True)
TABLE = Thing(RigidTransform(), 0.0, False)


def test_each_thing_has_a_button_and_the_chosen_one_is_pressed():
    html = rows({"a<b": CUBE, "table": TABLE}, "table")
    assert 'data-thing="a&lt;b" aria-pressed="false"' in html
    assert 'data-thing="table" aria-pressed="true">table<span>fixed</span>' in html


def test_where_a_thing_is():
    said = described("cube", CUBE, ThingProperties("cube", 0.20480000000000004, 0.8))
    assert said == (
        "cube: x y z 0.100 -0.200 0.025 m, roll pitch yaw 0.00 0.00 0.00 rad; 0.12 m/s\n"
        "0.2048 kg, friction 0.8"
    )


def test_only_what_is_known_of_a_thing_is_said():
    assert ThingProperties("table", None, 1.0).words() == "friction 1"
    assert ThingProperties("table").words() == ""


def test_the_list_has_the_gravity_with_its_unit():
    assert "Gravity 0 0 -9.81 m/s²" in listed(WorldView(gravity=(0.0, 0.0, -9.81)), "")
    assert "Gravity" not in listed(WorldView(), "")


def test_the_properties_of_another_thing_are_not_taken_for_this_one():
    view = WorldView(properties=ThingProperties("cube", 0.2, 0.8))
    assert properties_of(view, "cube").mass_kg == 0.2
    assert properties_of(view, "table") == ThingProperties("table")


@pytest.mark.parametrize("text", ["", "heavy", "nan", "inf", "1 2"])
def test_a_mass_that_is_not_a_number_is_a_sentence(text):
    with pytest.raises(ValueError, match=f"The mass is not a number: '{text}'"):
        read_number("mass", text)
