"""`arm run` and `arm pkg`: executables by their names here and in the course project."""

import json
import os
import sys

import pytest

from arm_cli.errors import NoSuchNameError
from arm_cli.main import main
from arm_cli.run import find_command


def test_run_replaces_the_process_by_the_executable(monkeypatch):
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
    # The profile limits the program to this machine; ROS must leave the range to it.
    assert called["environment"]["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SYSTEM_DEFAULT"
    profile = called["environment"]["FASTRTPS_DEFAULT_PROFILES_FILE"]
    assert profile.endswith("dds_profile_localhost.xml")


def test_the_course_project_s_names_work():
    for name, does in (
        ("arm_controller", "arm_controller_node"),
        ("publisher_defined", "publisher_defined"),
    ):
        *command, file = find_command("arm_control", name)
        assert tuple(command) == (
            *find_command("arm_controller", does),
            "--ros-args",
            "--params-file",
        )
        assert os.path.isfile(file)
        assert file.endswith("courses/S0.yaml")


def test_the_ros1_original_s_node_sends_its_own_pose():
    command = find_command("arm_controller", "arm_controller")
    assert "arm_controller_node" in " ".join(command)
    assert "__ns:=/arm" in command
    file = command[command.index("--params-file") + 1]
    assert os.path.isfile(file)
    assert file.endswith("params_ros1.yaml")


@pytest.mark.parametrize(
    ("package", "name", "does", "words"),
    [
        ("arm_controller", "arm_controller_node_ex", "arm_controller_node", ()),
        ("tf2_ros", "tf2_echo", "arm", ("tf", "echo")),
        ("tf2_tools", "view_frames", "arm", ("tf", "view_frames")),
    ],
)
def test_programs_of_ros_by_their_names(package, name, does, words, capsys):
    home = {"arm": "arm_cli"}.get(does, "arm_controller")
    assert find_command(package, name) == (*find_command(home, does), *words)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("package", "does"),
    [
        ("rviz2", "arm_viewer_node of arm_viewer"),
        ("rqt_image_view", "arm_viewer_node of arm_viewer"),
        ("joint_state_publisher_gui", "arm_viewer_node of arm_viewer"),
        ("rqt_graph", "arm graph"),
    ],
)
def test_the_replacement_of_a_missing_executable_is_named(package, does, capsys):
    assert find_command(package, package)
    said = f"{package} is not installed: {does} runs in place of {package}\n"
    assert capsys.readouterr().err == said


def test_an_executable_without_a_replacement_is_reported():
    with pytest.raises(NoSuchNameError, match="rqt_plot of rqt_plot is not available: the page"):
        find_command("rqt_plot", "rqt_plot")


def test_every_stand_in_exists():
    from launch_py.system.packages import Packages
    from launch_py.system.programs import NOTHING, stand_ins

    listed = list(stand_ins([sys.prefix]))
    assert len({(s.package, s.name) for s in listed}) == len(listed)
    for found in listed:
        if found.kind != NOTHING:
            assert Packages(os.environ).executable(*found.words[:2])


def test_an_installed_package_takes_precedence(tmp_path, monkeypatch):
    program = tmp_path / "lib" / "rviz2" / "rviz2"
    program.parent.mkdir(parents=True)
    program.touch(mode=0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert find_command("rviz2", "rviz2") == (str(program),)


@pytest.mark.parametrize("ending", ["", ".py"])
def test_the_arm_and_gripper_loop_is_found_by_its_course_name(ending):
    name = "arm_gripper_loop_controller"
    assert find_command("mycobot_system_tests", name + ending) == find_command(
        "arm_controller", name
    )


@pytest.mark.parametrize("name", ["example_gripper", "example_diff_drive"])
def test_the_demos_names_work(name):
    assert find_command("gz_ros2_control_demos", name) == find_command("arm_controller", name)


def test_an_unknown_executable_suggests_a_similar_one(capsys):
    assert main(["run", "arm_controller", "publisher_terminl"]) == 1
    assert "did you mean 'publisher_terminal'" in capsys.readouterr().err
    with pytest.raises(NoSuchNameError, match="no package 'arm_controler'"):
        find_command("arm_controler", "x")


def test_a_prefix_with_an_open_quotation_mark_is_reported(capsys):
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


def test_view_replaces_the_process_by_the_page(monkeypatch):
    called = {}

    def take_over(_program, command, _environment):
        called.update(command=command)
        raise OSError(2, "gone")

    monkeypatch.setattr(os, "execvpe", take_over)
    assert main(["view", "--port", "8123", "--publish-joint-states"]) == 2
    assert "arm_viewer_node" in " ".join(called["command"])
    parameters = ["-p", "port:=8123", "-p", "host:='127.0.0.1'", "-p", "publish_joint_states:=true"]
    assert called["command"][-7:] == ["--ros-args", *parameters]
    assert main(["view", "--host", "0.0.0.0", "--read-only"]) == 2
    assert called["command"][-4:] == ["-p", "host:='0.0.0.0'", "-p", "read_only:=true"]


def test_view_opens_a_recording(monkeypatch):
    called = {}

    def take_over(_program, command, _environment):
        called.update(command=command)
        raise OSError(2, "gone")

    monkeypatch.setattr(os, "execvpe", take_over)
    assert main(["view", "run 1.mcap", "--recordings", "1.0"]) == 2
    assert called["command"][-4:] == ["-p", 'recordings:="1.0"', "-p", 'recording:="run 1.mcap"']


def test_pkg_lists_executables_that_run_by_another_name(capsys):
    assert main(["pkg", "executables", "gz_ros2_control_demos"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "gz_ros2_control_demos example_diff_drive",
        "gz_ros2_control_demos example_gripper",
    ]
    assert main(["pkg", "executables", "--full-path", "gz_ros2_control_demos"]) == 0
    for path in capsys.readouterr().out.splitlines():
        assert os.access(path, os.X_OK)
