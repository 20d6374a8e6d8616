"""robot_state_publisher.launch.py: which processes its arguments come to, without starting any."""

import pytest

from arm_cli.main import main

FILE = ("mycobot_description", "robot_state_publisher.launch.py")
PUBLISHERS = {"robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui"}


@pytest.mark.parametrize(
    ("arguments", "started"),
    [
        (("jsp_gui:=false",), {"robot_state_publisher", "joint_state_publisher"}),
        (("jsp_gui:=false", "use_jsp:=false"), {"robot_state_publisher"}),
    ],
)
def test_one_publishes_joint_states_or_none(capsys, arguments, started):
    assert main(["launch", *FILE, "--print", "use_rviz:=false", *arguments]) == 0
    assert PUBLISHERS & set(capsys.readouterr().out.splitlines()) == started


def test_a_switch_that_is_none_is_refused(capsys):
    assert main(["launch", *FILE, "--print", "use_jsp:=perhaps"]) != 0
    assert "use_jsp" in capsys.readouterr().err
