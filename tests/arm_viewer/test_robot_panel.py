"""Which frames of /tf the links of robots hang on."""

import pytest

from arm_description.urdf import parse_urdf
from arm_viewer.panels.robot_panel import link_frames

ROBOT = """<robot name='r'><link name='base'/><link name='tip'/>
  <joint name='j' type='continuous'><parent link='base'/><child link='tip'/></joint></robot>"""
BARE = {"base": "base", "tip": "tip"}
PREFIXED = {"base": "left/base", "tip": "left/tip"}


@pytest.mark.parametrize(
    ("namespace", "known", "frames"),
    [
        ("", {"base", "tip"}, BARE),
        ("", {"base", "tip", "left/base", "left/tip"}, BARE),
        ("/left", {"base", "tip"}, BARE),
        ("/left", {"left/base", "left/tip"}, PREFIXED),
        ("/left", {"base", "tip", "left/base", "left/tip"}, PREFIXED),
        ("/left", set(), BARE),
    ],
)
def test_the_frame_below_the_robot_s_namespace_goes_first(namespace, known, frames):
    assert link_frames(parse_urdf(ROBOT), namespace, known) == frames


def test_a_link_s_name_may_begin_with_a_slash():
    robot = parse_urdf("<robot name='r'><link name='/base'/></robot>")
    assert link_frames(robot, "", {"base"}) == {"/base": "base"}
