"""An executable needs nothing from the environment that it is started in."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.ros


def test_runs_without_home_and_without_any_ros_variable(tmp_path):
    done = subprocess.run(
        [Path(sys.executable).with_name("publisher_terminal")],
        env={"ROS_DOMAIN_ID": os.environ["ROS_DOMAIN_ID"], "TMPDIR": str(tmp_path)},
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    # Of shared memory of other programs, which may have been killed.
    assert not [line for line in done.stderr.splitlines() if "RTPS_TRANSPORT_SHM" not in line]
