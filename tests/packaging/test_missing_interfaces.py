"""Where arm_interfaces is not installed, every command says so in one sentence and exits 2."""

import os
import subprocess
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from run_python import run_python

from arm_node.environment import INTERFACE_PACKAGES, PLANNING_PACKAGES

PROJECT = Path(__file__).parents[2] / "pyproject.toml"

# Python imports a module of this name at its start: here it hides the packages from the process
# and from all that it starts.
SITE_CUSTOMIZE = """
import sys
from importlib.machinery import PathFinder


class WithoutInterfaces(PathFinder):
    @classmethod
    def find_spec(cls, fullname, path=None, target=None):
        if fullname.partition(".")[0] in HIDDEN:
            return None
        return super().find_spec(fullname, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = WithoutInterfaces
"""

ARGUMENTS = {
    "arm": ["launch"],
    "spawner": ["position_controller"],
    "unspawner": ["position_controller"],
    "ros_gz_create": ["-topic", "robot_description"],
    "hardware_spawner": ["HardwareInterface", "--activate"],
    "mtc_demo": ["cartesian"],
}
SUPERVISOR = "launch_py"
"""Does not need the interfaces itself; it passes on what its processes print."""

SCRIPTS: dict[str, str] = tomllib.loads(PROJECT.read_text())["project"]["scripts"]
PLAIN = "arm_controller."
"""The package of plain rclpy nodes, which Python itself tells what they cannot import."""


@pytest.fixture
def run_without_interfaces(tmp_path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a console script where interface packages are hidden, by default the suite's own."""

    def run(
        name: str, *arguments: str, hidden: tuple[str, ...] = INTERFACE_PACKAGES
    ) -> subprocess.CompletedProcess[str]:
        (tmp_path / "sitecustomize.py").write_text(f"{SITE_CUSTOMIZE}HIDDEN = {hidden!r}\n")
        module, _, function = SCRIPTS[name].partition(":")
        start = (
            f"import sys; from {module} import {function}; "
            f"sys.argv[0] = {name!r}; sys.exit({function}())"
        )
        return run_python(
            "-c",
            start,
            *arguments,
            env={**os.environ, "PYTHONPATH": str(tmp_path), "ROS_LOG_DIR": str(tmp_path / "log")},
            cwd=tmp_path,
        )

    return run


def is_the_sentence(line: str) -> bool:
    return "pip install ./arm_interfaces" in line and all(p in line for p in INTERFACE_PACKAGES)


@pytest.mark.parametrize(
    "name", [n for n in SCRIPTS if n != SUPERVISOR and not SCRIPTS[n].startswith(PLAIN)]
)
def test_a_command_names_the_fix_and_exits_2(run_without_interfaces, name):
    done = run_without_interfaces(name, *ARGUMENTS.get(name, []))
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    (sentence,) = done.stderr.splitlines()
    assert is_the_sentence(sentence)


def test_the_supervisor_passes_the_sentence_on_and_exits_2(run_without_interfaces):
    done = run_without_interfaces(SUPERVISOR, "arm_viewer", "viewer.launch.py")
    assert done.returncode == 2, done.stderr
    assert sum(is_the_sentence(line) for line in done.stdout.splitlines()) == 1
    assert "Traceback" not in done.stdout


@pytest.mark.parametrize("words", [["move", "--state", "home"], ["teleop"]])
def test_a_verb_of_planning_names_what_only_planning_needs(run_without_interfaces, words):
    done = run_without_interfaces("arm", *words, hidden=PLANNING_PACKAGES)
    assert done.returncode == 2, done.stderr
    (sentence,) = done.stderr.splitlines()
    assert f"{', '.join(PLANNING_PACKAGES)} are not installed" in sentence
    assert "pip install ./arm_moveit_interfaces" in sentence
