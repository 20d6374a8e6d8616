"""mycobot_280_gazebo.sh: it starts everything, and cleans up at Ctrl-C."""

import os
import signal
import sys

import psutil
import pytest
from programs import Program

from arm_description.resources import resolve_uri

pytestmark = pytest.mark.slow


def lives(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:  # It has ended between the two.
        return False


def test_the_script_ends_all_that_it_has_started(tmp_path):
    script = resolve_uri("package://mycobot_bringup/scripts/mycobot_280_gazebo.sh")
    path = os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]])
    running = Program(
        ["bash", script, "viewer_port:=0", "use_rviz:=false"],
        {**os.environ, "PATH": path, "ROS_LOG_DIR": str(tmp_path)},
    )
    try:
        running.wait_until_ready()
        started = running.processes()
        assert len(started) >= 3
        assert running.stop() == 0
        assert "Cleaning up..." in running.output
        assert [process for process in started if lives(process)] == []
    finally:
        running.close(signal.SIGTERM)
