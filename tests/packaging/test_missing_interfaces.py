"""Where arm_interfaces is not installed, every command says so in one sentence and exits 2."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from arm_node.environment import INTERFACE_PACKAGES

PROJECT = Path(__file__).parents[2] / "pyproject.toml"

# Python imports a module of this name at its start: here it hides the packages from the process
# and from all that it starts.
SITE_CUSTOMIZE = f"""
import sys
from importlib.machinery import PathFinder


class WithoutInterfaces(PathFinder):
    @classmethod
    def find_spec(cls, fullname, path=None, target=None):
        if fullname.partition(".")[0] in {INTERFACE_PACKAGES!r}:
            return None
        return super().find_spec(fullname, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = WithoutInterfaces
"""

ARGUMENTS = {
    "arm": ["launch"],
    "launch_py": ["arm_gazebo", "arm_gazebo.launch.py"],
    "spawner": ["position_controller"],
}


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    scripts = tomllib.loads(PROJECT.read_text())["project"]["scripts"]
    metafunc.parametrize("script", list(scripts.items()), ids=list(scripts))


def test_a_command_names_the_fix_and_exits_2(script, tmp_path):
    name, target = script
    module, _, function = target.partition(":")
    (tmp_path / "sitecustomize.py").write_text(SITE_CUSTOMIZE)
    start = (
        f"import sys; from {module} import {function}; "
        f"sys.argv[0] = {name!r}; sys.exit({function}())"
    )
    done = subprocess.run(
        [sys.executable, "-c", start, *ARGUMENTS.get(name, [])],
        env={**os.environ, "PYTHONPATH": str(tmp_path), "ROS_LOG_DIR": str(tmp_path / "log")},
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert done.returncode == 2, done.stderr
    (sentence,) = done.stderr.splitlines()
    for package in INTERFACE_PACKAGES:
        assert package in sentence
    assert "pip install ./arm_interfaces" in sentence
    assert done.stdout == ""
