"""display.launch.py: which processes its arguments come to, without starting any."""

import runpy

import pytest

from arm_cli.main import main
from arm_description.resources import resolve_uri
from arm_description.urdf.description_source import source_of

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
    assert source_of(described(capsys)).file == model


def described(capsys) -> str:
    """Return the description that the state publisher of a printed plan gets."""
    printed = capsys.readouterr().out
    (line,) = (line for line in printed.splitlines() if "description_source" in line)
    return line[line.index("<?description_source") :]


@pytest.fixture
def describe():
    return runpy.run_path(str(resolve_uri("package://arm_description/launch/display.launch.py")))[
        "describe"
    ]


@pytest.fixture
def other_model(tmp_path):
    """A model whose `camera` is a switch, and that has another argument."""
    model = tmp_path / "other.urdf.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="camera" default="false"/><xacro:arg name="side" default="no"/>'
        '<link name="$(arg side)_hand"/>'
        '<xacro:if value="$(arg camera)"><link name="lens"/></xacro:if></robot>'
    )
    return str(model)


def test_another_model_keeps_its_own_default_of_an_argument_that_the_arm_has_too(
    describe, other_model
):
    text = describe(other_model, "", "front")
    assert "no_hand" in text
    assert "lens" not in text


def test_another_models_arguments_are_passed_on(describe, other_model):
    text = describe(other_model, "side:=left camera:=true", "front")
    assert "left_hand" in text
    assert "lens" in text


def test_the_arm_gets_the_requested_camera(describe):
    model = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    assert '<link name="camera_link"' in describe(model, "", "front")
    assert '<link name="camera_link"' not in describe(model, "", "none")


def test_an_argument_without_a_value_is_refused(capsys):
    line = ["launch", "arm_description", "display.launch.py", "--print", "model_args:=side=left"]
    assert main(line) == 2
    assert "'side=left' is not NAME:=VALUE" in capsys.readouterr().err
