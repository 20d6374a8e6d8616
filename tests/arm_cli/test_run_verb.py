"""`arm run` and `arm pkg`: executables by their names here and in the course project."""

import json
import os

import pytest

from arm_cli.errors import NotFoundError
from arm_cli.main import main
from arm_cli.run_verb import find_command


def test_it_becomes_the_executable(monkeypatch):
    called = {}

    def take_over(program, command, environment):
        called.update(program=program, command=command, environment=environment)
        raise OSError(2, "gone")

    monkeypatch.setattr(os, "execvpe", take_over)
    words = ["run", "--prefix", "nice -n 5", "arm_controller", "publisher_terminal", "--x", "-1"]
    assert main(words) == 2
    assert called["program"] == "nice"
    assert called["command"][:3] == ["nice", "-n", "5"]
    assert called["command"][-2:] == ["--x", "-1"]
    assert "publisher_terminal" in " ".join(called["command"])
    assert called["environment"]["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"


def test_the_course_project_s_names_work():
    command = find_command("arm_control", "arm_controller")
    assert "arm_controller_node" in " ".join(command)
    assert command[-1] == "desired_param:=[1.0, 0.5, 0.1, 0.5]"
    assert find_command("arm_control", "publisher_defined") == find_command(
        "arm_controller", "publisher_defined"
    )


@pytest.mark.parametrize("ending", ["", ".py"])
def test_the_loop_of_arm_and_gripper_is_found_by_its_course_s_name(ending):
    name = "arm_gripper_loop_controller"
    assert find_command("mycobot_system_tests", name + ending) == find_command(
        "arm_controller", name
    )


@pytest.mark.parametrize("name", ["example_gripper", "example_diff_drive"])
def test_the_demos_names_work(name):
    assert find_command("gz_ros2_control_demos", name) == find_command("arm_controller", name)


def test_an_unknown_executable_names_the_near_one(capsys):
    assert main(["run", "arm_controller", "publisher_terminl"]) == 1
    assert "did you mean 'publisher_terminal'" in capsys.readouterr().err
    with pytest.raises(NotFoundError, match="no package 'arm_controler'"):
        find_command("arm_controler", "x")


def test_a_prefix_without_its_closing_quotation_is_a_sentence(capsys):
    assert main(["run", "--prefix", '"', "arm_controller", "publisher_terminal"]) == 2
    assert capsys.readouterr().err == "arm run: --prefix '\"': No closing quotation\n"


def test_pkg_lists_packages_and_executables(capsys):
    assert main(["pkg", "list", "--json"]) == 0
    assert {"arm_cli", "std_msgs"} <= set(json.loads(capsys.readouterr().out))
    assert main(["pkg", "executables", "arm_controller"]) == 0
    assert "arm_controller publisher_terminal\n" in capsys.readouterr().out
    assert main(["pkg", "executables", "arm_controler"]) == 1
    assert "did you mean 'arm_controller'" in capsys.readouterr().err


def test_pkg_executables_by_their_files(capsys):
    assert main(["pkg", "executables", "--full-path", "arm_cli"]) == 0
    [path] = capsys.readouterr().out.splitlines()
    assert os.access(path, os.X_OK)
    assert os.path.basename(path) == "arm"


def test_pkg_xml(capsys):
    assert main(["pkg", "xml", "arm_cli"]) == 0
    assert "<name>arm_cli</name>" in capsys.readouterr().out
    assert main(["pkg", "xml", "arm_cli", "--tag", "name"]) == 0
    assert capsys.readouterr().out == "arm_cli\n"
    assert main(["pkg", "xml", "arm_cli", "--tag", "nam"]) == 1
    assert "has no element 'nam'; did you mean 'name'" in capsys.readouterr().err
    assert main(["pkg", "xml", "arm_cl"]) == 1
    assert "did you mean 'arm_cli'" in capsys.readouterr().err


def test_pkg_prefix(capsys):
    assert main(["pkg", "prefix", "arm_cli"]) == 0
    prefix = capsys.readouterr().out.strip()
    assert main(["pkg", "prefix", "--share", "arm_cli"]) == 0
    assert capsys.readouterr().out == f"{prefix}/share/arm_cli\n"
    assert main(["pkg", "prefix", "arm_cl"]) == 1
    assert "did you mean 'arm_cli'" in capsys.readouterr().err


def test_view_becomes_the_page(monkeypatch):
    called = {}

    def take_over(_program, command, _environment):
        called.update(command=command)
        raise OSError(2, "gone")

    monkeypatch.setattr(os, "execvpe", take_over)
    assert main(["view", "--port", "8123", "--publish-joint-states"]) == 2
    assert "arm_viewer_node" in " ".join(called["command"])
    parameters = ["-p", "port:=8123", "-p", "publish_joint_states:=true"]
    assert called["command"][-5:] == ["--ros-args", *parameters]
