"""display.launch.py: which processes its arguments come to, without starting any."""

import pytest

from arm_cli.main import main

NODES = {"robot_state_publisher", "joint_state_publisher", "arm_viewer_node"}


@pytest.mark.parametrize(
    ("arguments", "started"),
    [
        ((), {"robot_state_publisher", "arm_viewer_node"}),
        (("viewer:=false",), {"robot_state_publisher", "joint_state_publisher"}),
        (("viewer:=false", "use_jsp:=false"), {"robot_state_publisher"}),
    ],
)
def test_one_publishes_joint_states_or_none(capsys, arguments, started):
    line = ["launch", "arm_description", "display.launch.py", "--print", "use_rviz:=false"]

    assert main([*line, *arguments]) == 0
    assert NODES & set(capsys.readouterr().out.splitlines()) == started
