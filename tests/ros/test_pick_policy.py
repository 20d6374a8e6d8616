"""The policy that was learned from demonstrations picks in the real launch over ROS."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from run_python import run_python

EXAMPLE = Path(__file__).parents[2] / "examples" / "pick_policy"
TIMEOUT_S = 250.0


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_the_policy_lifts_cylinders_over_ros(launch):
    # At half speed, so that a busy machine does not miss a pick.
    launched = launch("mycobot", "load_controllers:=false", "real_time_factor:=0.5")
    launched.wait_until_ready()
    spawn = ["run", "controller_manager", "spawner", "joint_state_broadcaster"]
    parameters = ["pick_policy_controller", "--param-file", str(EXAMPLE / "controllers.yaml")]
    subprocess.run([sys.executable, "-m", "arm_cli", *spawn, *parameters], check=True)
    done = run_python(
        str(EXAMPLE / "pick_node.py"), "--picks", "2", "--seed", "5", timeout_s=TIMEOUT_S
    )
    # How often it succeeds is tested without ROS.
    said = re.search(r"(\d+) of 2 picks lifted the cylinder", done.stdout)
    assert said, done.stdout + done.stderr
    assert int(said[1]) >= 1, done.stderr
