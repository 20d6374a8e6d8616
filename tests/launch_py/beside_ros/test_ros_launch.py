"""This package's launch files, read by ROS 2's own `launch`: here its double."""

import subprocess
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from run_python import run_python

DOUBLE = Path(__file__).with_name("launch_double.py").read_text()
OURS = """
from launch_py import DeclareLaunchArgument, ExecuteProcess, LaunchDescription, Finished, ReadyPanel
from launch_py.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("word", description="what to say"),
            DeclareLaunchArgument("code", default_value="0", choices=["0", "3"]),
            ReadyPanel(title="It is up"),
            ExecuteProcess(
                cmd=["sh", "-c", ["echo said ", LaunchConfiguration("word"), "; exit ",
                                  LaunchConfiguration("code")]],
                name="say",
            ),
        ]
    )
"""
THEIRS = """
import launch
from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [launch.actions.IncludeLaunchDescription({path!r}, {{"word": "by include"}})]
    )
"""


@pytest.fixture
def ours(tmp_path):
    path = tmp_path / "ours.launch.py"
    path.write_text(OURS)
    return str(path)


@pytest.fixture
def ros2_launch(tmp_path, launch_environment):
    """Run code in a Python that has ROS 2's `launch`."""
    package = tmp_path / "ros" / "launch"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(DOUBLE)

    def run(code: str) -> subprocess.CompletedProcess[str]:
        return run_python(
            "-c",
            f"import launch, sys\nsys.exit(launch.{code})",
            env={**launch_environment, "PYTHONPATH": str(package.parent)},
        )

    return run


def test_a_file_runs_with_its_arguments(ros2_launch, ours):
    done = ros2_launch(f"run({ours!r}, {{'word': 'hello'}})")
    assert (done.returncode, done.stderr) == (0, "")
    assert "[say] said hello" in done.stdout


def test_the_exit_code_is_that_of_the_launcher(ros2_launch, ours):
    done = ros2_launch(f"run({ours!r}, {{'word': 'hello', 'code': '3'}})")
    assert done.returncode == 3


def test_the_arguments_are_listed_and_checked(ros2_launch, ours):
    shown = ros2_launch(f"show_args({ours!r})").stdout
    assert "'word': what to say default: None\n'code': no description given default: '0'" in shown
    assert "'word' was not provided" in ros2_launch(f"run({ours!r}, {{}})").stderr
    wrong = ros2_launch(f"run({ours!r}, {{'word': 'a', 'code': '4'}})")
    assert "'4' is not valid" in wrong.stderr


def test_another_file_includes_it(ros2_launch, ours, tmp_path):
    theirs = tmp_path / "theirs.launch.py"
    theirs.write_text(THEIRS.format(path=ours))
    done = ros2_launch(f"run({str(theirs)!r}, {{}})")
    assert (done.returncode, done.stderr) == (0, "")
    assert "[say] said by include" in done.stdout
    assert "'code': no description" in ros2_launch(f"show_args({str(theirs)!r})").stdout


def test_a_description_without_a_file_says_how_to_start_it(ros2_launch):
    done = ros2_launch("run and __import__('launch_py').LaunchDescription([])")
    assert "is not in a file FILE.launch.py: start it with `arm launch`" in done.stderr


@pytest.mark.parametrize(
    ("package", "file", "argument"),
    [
        ("arm_gazebo", "arm_gazebo.launch.py", "world"),
        ("mycobot_gazebo", "mycobot.gazebo.launch.py", "robot_name"),
        ("arm_description", "display.launch.py", "model"),
    ],
)
def test_the_suite_s_own_files_show_their_arguments(ros2_launch, package, file, argument):
    path = f"{get_package_share_directory(package)}/launch/{file}"
    done = ros2_launch(f"show_args({path!r})")
    assert (done.returncode, done.stderr) == (0, "")
    assert f"'{argument}': " in done.stdout


def test_this_package_s_own_launcher_reads_its_files_as_before(ros2_launch, ours):
    code = f"run and __import__('launch_py.__main__').__main__.main([{ours!r}, 'word:=x'])"
    done = ros2_launch(code)
    assert "[say] said x" in done.stdout, done.stderr
