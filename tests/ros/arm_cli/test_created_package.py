"""The test of a package from `arm pkg create`, installed as by colcon, passes."""

import os
import sys
import sysconfig

import pytest
from run_python import run_python

pytestmark = pytest.mark.slow

TIMEOUT_S = 150.0


def test_a_created_package_s_own_test_passes(tmp_path):
    def run(*command: str, folder, **environment: str) -> str:
        done = run_python(
            *command, env={**os.environ, **environment}, cwd=folder, timeout_s=TIMEOUT_S
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("-m", "arm_cli", "pkg", "create", "my_arm", folder=tmp_path)
    prefix = tmp_path / "install"
    words = ("--prefix", str(prefix), "--single-version-externally-managed", "--record", "files")
    run("setup.py", "-q", "install", *words, folder=tmp_path / "my_arm")
    modules = sysconfig.get_path("purelib", vars={"base": str(prefix)})
    installed = {
        "PYTHONPATH": modules,
        "AMENT_PREFIX_PATH": str(prefix),
        "PATH": os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]]),
    }
    listed = run("-m", "arm_cli", "pkg", "executables", "my_arm", folder=tmp_path, **installed)
    assert listed == "my_arm my_arm_node\n"
    passed = run("-m", "pytest", "-q", "my_arm/test", folder=tmp_path, **installed)
    assert "1 passed" in passed
