"""`arm run mycobot_mtc_demos pick_place_demo`: the task moves the simulated cylinder."""

import subprocess
import sys

import pytest
from simulated import Simulated

pytestmark = pytest.mark.slow

DEMO = (sys.executable, "-m", "arm_cli", "run", "mycobot_mtc_demos", "pick_place_demo")
TIMEOUT_S = 250.0


@pytest.mark.timeout(400)
def test_the_cylinder_stands_at_its_new_place(launch, client):
    launch("mycobot", "planning:=true").wait_until_ready()
    done = subprocess.run(
        [*DEMO, "--ros-args", "-p", "execute:=true"],
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Task executed successfully" in done.stderr
    pose = Simulated(client).state_of("red_cylinder").pose
    assert (pose.position.x, pose.position.y) == pytest.approx((-0.183, -0.14), abs=0.01)
    assert pose.position.z == pytest.approx(0.175, abs=2e-3)
    # Upright: no turn about x or y.
    assert abs(pose.orientation.x) + abs(pose.orientation.y) < 0.02
