"""The figures beside the overlays."""

from arm_description.urdf.robot import Joint
from arm_viewer.panels.overlay_panel import load_row


def test_a_load_has_its_unit_its_part_of_the_limit_and_its_colour():
    row = load_row(Joint("a<b", "revolute", "base", "hand"), -0.5, -2.5)
    assert "a&lt;b" in row
    assert "-2.500 N m (50%)" in row
    assert "rgb(240,173,0)" in row
    assert "1.000 N (" in load_row(Joint("rail", "prismatic", "base", "hand"), 0.1, 1.0)
