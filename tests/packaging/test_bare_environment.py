"""An executable needs nothing from the environment that it is started in."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.ros


def run_bare(folder: Path, *words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    program, *arguments = words
    return subprocess.run(
        [Path(sys.executable).with_name(program), *arguments],
        env={"ROS_DOMAIN_ID": os.environ["ROS_DOMAIN_ID"], "TMPDIR": str(folder), **variables},
        cwd=folder,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )


def test_runs_without_home_and_without_any_ros_variable(tmp_path):
    done = run_bare(tmp_path, "spawner", "x", "--controller-manager-timeout", "0.5")
    assert done.returncode == 1, done.stderr
    assert "Traceback" not in done.stderr


def test_a_plain_node_runs_without_any_ros_variable(tmp_path):
    node = ("publisher_defined", "--ros-args", "-p", "match_timeout:=0.1")
    done = run_bare(tmp_path, *node, HOME=str(tmp_path))
    assert done.returncode == 1, done.stderr
    assert "nobody listens on /position_controller/commands" in done.stderr


def test_a_plain_node_without_home_says_so(tmp_path):
    done = run_bare(tmp_path, "publisher_terminal")
    assert done.returncode == 1
    assert "cannot start the node: " in done.stderr
    assert "Traceback" not in done.stderr
