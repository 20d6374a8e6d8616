"""The learned policy drives the real launch over ROS."""

import re
from pathlib import Path

import pytest
from run_python import run_python

NODE = Path(__file__).parents[2] / "examples" / "reach_policy" / "drive_node.py"
TIMEOUT_S = 150.0


@pytest.mark.slow
def test_the_policy_reaches_random_goals_over_ros(launch):
    # At half speed, so that a busy machine does not miss a goal.
    launched = launch("camera:=none", "real_time_factor:=0.5")
    launched.wait_until_ready()
    done = run_python(str(NODE), "--goals", "4", "--seed", "5", timeout_s=TIMEOUT_S)
    # How often it succeeds is tested without ROS.
    said = re.search(r"(\d+) of 4 goals reached", done.stdout)
    assert said, done.stdout + done.stderr
    assert int(said[1]) >= 3, done.stderr
