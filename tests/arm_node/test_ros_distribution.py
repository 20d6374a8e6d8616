"""The distribution is known by the version of rclpy."""

import os

import pytest
from run_python import run_python


@pytest.mark.parametrize(
    ("version", "name"), [("7.1.6", "jazzy"), ("9.1.2", "kilted"), ("99.0.0", "jazzy")]
)
def test_a_version_of_rclpy_is_a_distribution(tmp_path, version, name):
    share = tmp_path / "share" / "rclpy"
    share.mkdir(parents=True)
    (share / "package.xml").write_text(f"<package><version>{version}</version></package>")
    code = "from arm_node.ros_distribution import ros_distribution as d; print(d())"
    environ = {**os.environ, "AMENT_PREFIX_PATH": str(tmp_path)}
    done = run_python("-c", code, env=environ)
    assert done.stdout.strip() == name, done.stderr
