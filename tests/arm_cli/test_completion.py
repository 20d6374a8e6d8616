"""Completions that a shell gets on Tab."""

import os
import subprocess
import sys

import pytest
from run_python import run_python

from arm_cli.main import main


def offered(line: str, tmp_path) -> list[str]:
    answer = tmp_path / "words"
    subprocess.run(
        [sys.executable, "-m", "arm_cli"],
        env={
            **os.environ,
            "_ARGCOMPLETE": "1",
            "_ARGCOMPLETE_IFS": "\n",
            "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
            "COMP_LINE": line,
            "COMP_POINT": str(len(line)),
            "COMP_TYPE": "9",
        },
        timeout=60,
        check=True,
    )
    return [word.strip() for word in answer.read_text().split("\n") if word.strip()]


def test_tab_offers_the_verbs_of_a_family(tmp_path):
    words = offered("arm control ", tmp_path)
    assert {"list_controllers", "switch_controllers", "view_controller_chains"} <= set(words)


def test_tab_completes_options_types_and_executables(tmp_path):
    assert offered("arm topic echo --onc", tmp_path) == ["--once"]
    types = offered("arm interface show std_msgs/msg/Float64", tmp_path)
    assert "std_msgs/msg/Float64MultiArray" in types
    assert "publisher_terminal" in offered("arm run arm_controller ", tmp_path)


@pytest.mark.parametrize(
    ("shell", "part"), [("bash", "complete "), ("zsh", "compdef"), ("fish", "--command arm")]
)
def test_the_completion_script_fits_the_shell(capsys, shell, part):
    assert main(["completion", shell]) == 0
    assert part in capsys.readouterr().out


LAUNCH_FILE = """
from launch_py import DeclareLaunchArgument, LaunchDescription

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="slow", choices=["slow", "fast"]),
        DeclareLaunchArgument("camera", default_value="false"),
        DeclareLaunchArgument("name"),
    ])
"""


def test_tab_knows_launch_files_and_packages_that_have_some(tmp_path):
    words = offered("arm launch ", tmp_path)
    assert {"mycobot", "arm_gazebo", "world:="} <= set(words)
    assert "arm_cli" not in words
    assert "sim.launch.py" in offered("arm launch arm_gazebo s", tmp_path)
    (tmp_path / "mine.launch.py").write_text(LAUNCH_FILE)
    assert offered(f"arm launch {tmp_path}/m", tmp_path) == [f"{tmp_path}/mine.launch.py"]


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("sp", {"speed:="}),
        ("speed:=", {"speed:=slow", "speed:=fast"}),
        ("speed:=f", {"speed:=fast"}),
        ("camera:=", {"camera:=true", "camera:=false"}),
        ("camera:=true n", {"name:="}),
        ("name:=", set()),
    ],
)
def test_tab_knows_the_arguments_of_a_launch_file_and_their_values(tmp_path, typed, words):
    file = tmp_path / "mine.launch.py"
    file.write_text(LAUNCH_FILE)
    assert set(offered(f"arm launch {file} {typed}", tmp_path)) == words


def test_tab_knows_the_shipped_worlds_and_completes_paths(tmp_path):
    worlds = offered("arm launch arm_gazebo sim.launch.py world:=", tmp_path)
    assert {"world:=empty", "world:=house", "world:=shapes"} <= set(worlds)
    (tmp_path / "robots").mkdir()
    (tmp_path / "mine.urdf").touch()
    line = f"arm launch arm_gazebo sim.launch.py model:={tmp_path}/"
    assert set(offered(line, tmp_path)) == {
        f"model:={tmp_path}/{name}" for name in ("mine.urdf", "robots/", "words")
    }
    assert offered(f"{line}m", tmp_path) == [f"model:={tmp_path}/mine.urdf"]


def test_tab_imports_only_what_the_typed_verb_needs():
    code = (
        "import sys; from arm_cli.verbs import ARM; from arm_cli.word_completion import _parser; "
        "_parser(ARM); print(*sys.modules)"
    )
    line = "arm topic echo --onc"
    environment = {**os.environ, "COMP_LINE": line, "COMP_POINT": str(len(line))}
    done = run_python("-c", code, env=environment, check=True)
    imported = set(done.stdout.split())
    assert "arm_cli.topic.echo" in imported
    assert not {"rclpy", "launch_py.actions", "arm_cli.topic.measuring", "arm_cli.param"} & imported
