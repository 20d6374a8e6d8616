"""mycobot_280_gazebo.sh: it starts everything, and cleans up at Ctrl-C."""

import os
import signal
import subprocess
import sys

import psutil
import pytest

from arm_description.resources import find_package

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def lives(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:  # It has ended between the two.
        return False


def test_the_script_ends_all_that_it_has_started(tmp_path):
    script = find_package("mycobot_bringup") / "scripts" / "mycobot_280_gazebo.sh"
    path = os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]])
    running = subprocess.Popen(
        ["bash", str(script), "viewer_port:=0", "use_rviz:=false"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "PATH": path, "ROS_LOG_DIR": str(tmp_path)},
    )
    assert running.stdout is not None
    try:
        lines = []
        for line in running.stdout:
            lines.append(line)
            if line.startswith("ready "):
                break
        else:
            pytest.fail("".join(lines))
        started = psutil.Process(running.pid).children(recursive=True)
        assert len(started) >= 3
        running.send_signal(signal.SIGINT)
        rest, _ = running.communicate(timeout=60.0)
        assert running.returncode == 0
        assert "Cleaning up..." in rest
        assert [process for process in started if lives(process)] == []
    finally:
        if running.poll() is None:
            running.send_signal(signal.SIGTERM)
            running.communicate(timeout=60.0)
