"""ROS 2's own tools find the executables in <prefix>/lib/<package>; this package's do as before."""

import os
import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

from launch_py.system.packages import MARKERS, STAND_IN_MARK, Packages

SCRIPTS = [
    (entry.value.partition(".")[0], entry.name)
    for entry in distribution("arm-suite").entry_points
    if entry.group == "console_scripts"
]
STAND_INS = [
    ("robot_state_publisher", "robot_state_publisher"),
    ("joint_state_publisher", "joint_state_publisher"),
    ("controller_manager", "ros2_control_node"),
    ("controller_manager", "spawner"),
    ("controller_manager", "unspawner"),
    ("controller_manager", "hardware_spawner"),
    ("tf2_ros", "static_transform_publisher"),
]


@pytest.fixture(autouse=True)
def _index(monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", sys.prefix)


def executables(package: str) -> dict[str, str]:
    """Return what `ros2 pkg executables` finds: the files of lib/PACKAGE that can be run."""
    folder = Path(get_package_prefix(package), "lib", package)
    paths = (Path(where, name) for where, _, names in os.walk(folder) for name in names)
    return {path.name: str(path) for path in paths if os.access(path, os.X_OK)}


@pytest.mark.parametrize(("package", "name"), [*SCRIPTS, *STAND_INS])
def test_every_executable_stands_in_its_package_s_folder(package, name):
    assert name in executables(package)


@pytest.mark.parametrize(
    ("package", "name", "said"),
    [
        ("tf2_ros", "static_transform_publisher", "usage: static_transform_publisher [--x X]"),
        ("controller_manager", "spawner", "usage: spawner"),
        ("arm_cli", "arm", "usage: arm"),
    ],
)
def test_it_runs_from_anywhere_without_the_environment_s_python(package, name, said, tmp_path):
    done = subprocess.run(
        [executables(package)[name], "--help"],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
        env={"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)},
    )
    assert said in done.stdout, done.stderr


def test_a_stand_in_is_no_package_for_this_launcher():
    packages = Packages(os.environ)
    assert "tf2_ros" not in packages.names()
    command = packages.executable("robot_state_publisher", "robot_state_publisher")
    assert command == packages.executable("arm_description", "robot_state_publisher")
    assert command[0] == sys.executable


def test_a_real_package_of_the_same_name_takes_precedence(tmp_path, monkeypatch):
    marker = tmp_path / MARKERS / "tf2_ros"
    marker.parent.mkdir(parents=True)
    marker.touch()
    program = tmp_path / "lib" / "tf2_ros" / "static_transform_publisher"
    program.parent.mkdir(parents=True)
    program.touch(mode=0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}:{sys.prefix}")
    packages = Packages(os.environ)
    assert packages.executable("tf2_ros", "static_transform_publisher") == (str(program),)
    assert "tf2_ros" in packages.names()


def test_the_marks_agree():
    root = Path(__file__).parents[3]
    assert f"MARK = {STAND_IN_MARK!r}".replace("'", '"') in (root / "hatch_build.py").read_text()
