"""The list of the world's things, as HTML and in words."""

from arm_node.rigid_transform import RigidTransform
from arm_viewer.panels.world_panel import described, rows
from arm_viewer.world.world_view import Thing

CUBE = Thing(RigidTransform((0.1, -0.2, 0.0255)), 0.123, True)
TABLE = Thing(RigidTransform(), 0.0, False)


def test_each_thing_has_a_button_and_the_chosen_one_is_pressed():
    html = rows({"a<b": CUBE, "table": TABLE}, "table")
    assert 'data-thing="a&lt;b" aria-pressed="false"' in html
    assert 'data-thing="table" aria-pressed="true">table<span>fixed</span>' in html


def test_where_a_thing_is():
    said = described("cube", CUBE)
    assert said == ("cube: x y z 0.100 -0.200 0.025 m, roll pitch yaw 0.00 0.00 0.00 rad; 0.12 m/s")
