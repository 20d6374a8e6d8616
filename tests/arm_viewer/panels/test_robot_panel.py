"""The frames of /tf that belong to the links of robots, and the poses of those that /tf lacks."""

import math
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest

from arm_description.urdf.parser import parse_urdf
from arm_viewer.panels.robot_panel import STARTUP_WAIT_S, RobotPanel, link_frames
from arm_viewer.requests import ShowContacts
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import ContactForces, Description, Snapshot

ROBOT = """<robot name='r'><link name='base'/><link name='tip'/>
  <joint name='j' type='continuous'><parent link='base'/><child link='tip'/></joint></robot>"""
POINTS = np.ones((1, 3), np.float32)
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
def test_the_frame_below_the_robots_namespace_takes_precedence(namespace, known, frames):
    assert link_frames(parse_urdf(ROBOT), namespace, known) == frames


def test_a_link_s_name_may_begin_with_a_slash():
    robot = parse_urdf("<robot name='r'><link name='/base'/></robot>")
    assert link_frames(robot, "", {"base"}) == {"/base": "base"}


def test_a_robot_without_joint_states_is_where_its_hardware_has_it():
    poses = MagicMock()
    frames, gui = Frames(MagicMock(), poses), MagicMock()
    panel = RobotPanel(MagicMock(), frames, poses, MagicMock(), MagicMock(), [].append, bool)
    problem = MagicMock()
    gui.add_html.side_effect = [MagicMock(), problem]
    panel.build(gui)
    described = {"/robot_description": Description("/robot_description", "", parse_urdf(ROBOT))}

    def show(made_s, **more):
        panel.update(Snapshot(made_s=made_s, descriptions=described, **more))
        return frames.known["tip"].rotation if "tip" in frames.known else None

    late_s = 2.0 * STARTUP_WAIT_S
    show(0.0)
    assert show(late_s) == pytest.approx((0.0, 0.0, 0.0, 1.0))
    assert "No position for j" in problem.content
    for angle in (0.5, 1.0):
        rotation = show(late_s, hardware_positions={"": {"j": angle}})
        assert rotation == pytest.approx((math.sin(angle / 2), 0.0, 0.0, math.cos(angle / 2)))
    assert problem.visible is False


def test_contacts_are_asked_for_while_somebody_looks():
    poses, scene = MagicMock(), MagicMock()
    frames, gui, sent, watched = Frames(scene, poses), MagicMock(), [], [True]
    boxes = {}
    gui.add_checkbox.side_effect = lambda label, value, **_: boxes.setdefault(
        label, SimpleNamespace(value=value)
    )
    panel = RobotPanel(
        scene, frames, poses, MagicMock(), MagicMock(), sent.append, lambda: watched[0]
    )
    panel.build(gui)
    touching = ContactForces("world", POINTS, np.zeros((1, 2, 3), np.float32), ("a on b: 1 N",))
    panel.update(Snapshot(contacts=touching))
    assert sent == []
    scene.add_point_cloud.assert_not_called()
    boxes["Contacts"].value = True
    panel.update(Snapshot(contacts=touching))
    panel.update(Snapshot(contacts=touching))
    assert sent == [ShowContacts(True)]
    assert np.array_equal(scene.add_point_cloud.call_args.args[1], POINTS)
    watched[0] = False
    panel.update(Snapshot())
    assert sent == [ShowContacts(True), ShowContacts(False)]
    scene.add_point_cloud.return_value.remove.assert_called_once()
