"""robot_state_publisher.launch.py: which processes its arguments come to, without starting any."""

import os

import pytest

from arm_cli.main import main
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.system.packages import Packages

FILE = ("mycobot_description", "robot_state_publisher.launch.py")
PUBLISHERS = {
    "arm_viewer_node",
    "robot_state_publisher",
    "joint_state_publisher",
    "joint_state_publisher_gui",
}


@pytest.mark.parametrize(
    ("arguments", "started"),
    [
        ((), {"robot_state_publisher", "arm_viewer_node"}),
        (("jsp_gui:=false",), {"robot_state_publisher", "joint_state_publisher"}),
        (("jsp_gui:=false", "use_jsp:=false"), {"robot_state_publisher"}),
    ],
)
def test_one_publishes_joint_states_or_none(capsys, arguments, started):
    assert main(["launch", *FILE, "--print", "use_rviz:=false", *arguments]) == 0
    assert PUBLISHERS & set(capsys.readouterr().out.splitlines()) == started


@pytest.mark.parametrize("slider", ["true", "false"])
def test_without_rviz_the_page_shows_the_robot(slider):
    file = Packages(os.environ).launch_file(*FILE)
    arguments = {"use_rviz": "true", "jsp_gui": slider}
    environ = {**os.environ, "PATH": "/bin"}
    plan = expand_description(read_launch_file(file), arguments, environ, file)
    # One page, with sliders or without.
    assert [step.name for step in plan.processes].count("arm_viewer_node") == 1
    assert "rviz2" not in [step.name for step in plan.processes]
    assert [w for w in plan.warnings if w.startswith("RViz (rviz2)") and "not installed" in w]


@pytest.mark.parametrize(
    ("arguments", "frame"),
    [
        ((), "base_link"),
        (("prefix:=left_", "use_gripper:=false"), "left_base_link"),
        (("base_link:=foot",), "foot"),
    ],
)
def test_rviz_looks_from_a_frame_that_the_robot_has(
    capsys, tmp_path, monkeypatch, arguments, frame
):
    program = tmp_path / "rviz2"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)

    words = ("--print", "use_rviz:=true", "jsp_gui:=false", *arguments)
    assert main(["launch", *FILE, *words]) == 0
    printed = capsys.readouterr().out.split()
    assert printed[printed.index("-f") + 1] == frame


def test_a_value_that_is_neither_true_nor_false_is_refused(capsys):
    assert main(["launch", *FILE, "--print", "use_jsp:=perhaps"]) != 0
    assert "use_jsp" in capsys.readouterr().err
