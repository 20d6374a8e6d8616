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


def test_the_page_looks_for_meshes_where_the_model_is(capsys, tmp_path):
    model = tmp_path / "arm_x" / "urdf" / "arm.urdf"
    model.parent.mkdir(parents=True)
    model.write_text('<robot name="r"><link name="a"/></robot>')
    (tmp_path / "arm_x" / "package.xml").write_text("<package><name>arm_x</name></package>")
    assert (
        main(["launch", "arm_description", "display.launch.py", "--print", f"model:={model}"]) == 0
    )
    page = capsys.readouterr().out.partition("\narm_viewer_node\n")[2]
    (folders,) = (line for line in page.splitlines() if "GZ_SIM_RESOURCE_PATH=" in line)
    assert str(tmp_path) in folders.partition("=")[2].split(":")
