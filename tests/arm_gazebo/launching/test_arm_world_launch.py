"""arm_world.launch.py: the arguments that reach the description."""

import runpy
import shlex

import pytest

from arm_cli.main import main
from arm_description.resources import find_package
from arm_description.xacro_arguments import arguments_of_text
from arm_description.xacro_expansion import expand_xacro_file

SWITCHED = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="camera" default="false"/>
  <link name="base"/>
  <xacro:if value="$(arg camera)"><link name="lens"/></xacro:if>
</robot>
"""


@pytest.fixture
def launch_file():
    return runpy.run_path(str(find_package("arm_gazebo") / "launch" / "arm_world.launch.py"))


@pytest.fixture
def defaults(launch_file):
    return {name: default for name, (default, *_) in launch_file["DESCRIPTION_ARGUMENTS"].items()}


def test_a_model_that_has_an_argument_of_the_arms_in_another_sense_keeps_its_default(
    capsys, tmp_path
):
    model = tmp_path / "other.urdf.xacro"
    model.write_text(SWITCHED)
    line = ["launch", "arm_gazebo", "arm_world.launch.py", "--print", f"model:={model}"]
    assert main([*line, "controllers:="]) == 0
    assert "arm_gazebo_node" in capsys.readouterr().out


def test_what_is_given_is_passed_on(launch_file, defaults):
    given = defaults | {"prefix": "x y", "j1_limit": "0.25"}
    passed = launch_file["assignments"](**given)
    assert arguments_of_text(passed) == {"prefix": "x y", "j1_limit": "0.25"}
    assert len(shlex.split(passed)) == 2


def test_what_is_left_out_is_the_same_in_the_description(launch_file, defaults):
    assert launch_file["assignments"](**defaults) == ""
    model = find_package("arm_description") / "urdf" / "arm.urdf.xacro"
    assert defaults.items() <= expand_xacro_file(model).arguments.items()
