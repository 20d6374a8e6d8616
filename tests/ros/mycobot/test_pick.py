"""The controllers that are loaded afterwards, and the pick, in processes of their own."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile

CONTROLLERS = ("joint_state_broadcaster", "arm_controller", "gripper_action_controller")
HELD = re.compile(r"The object is held, at (\S+) rad")
PICK_TIMEOUT_S = 150.0


@pytest.mark.timeout(400)
def test_controllers_are_loaded_one_after_the_other_and_the_cylinder_is_picked(launch, tmp_path):
    recording = tmp_path / "pick.run"
    running = launch(
        "mycobot", "load_controllers:=false", "real_time_factor:=3", f"record_run:={recording}"
    )
    running.wait_until_ready()
    loading = launch("mycobot_moveit_config", "load_ros2_controllers.launch.py")
    for name in CONTROLLERS:
        loading.wait_for_line(f"spawner_{name} ended with exit code 0")
    ended = [line for line in loading.lines if "ended with exit code 0" in line]
    assert [line.split()[1] for line in ended] == [f"spawner_{name}" for name in CONTROLLERS]

    picked = pick("use_sim_time:=true")
    assert picked.returncode == 0, picked.stderr
    assert "The object was picked up, held and put back" in picked.stderr
    held = [float(position) for position in HELD.findall(picked.stderr)]
    # Of the gripper, where its pads meet on the cylinder: after the grip, and after the hold.
    assert held == pytest.approx([-0.25, -0.25], abs=0.01)

    nothing = pick("position:=[0.1, -0.2]")
    assert nothing.returncode == 1, nothing.stderr
    assert "there is nothing between the fingers" in nothing.stderr
    assert "Traceback" not in picked.stderr + nothing.stderr

    # Goals, switches, friction and contact: all of it repeats to the last bit.
    assert running.stop() == 0
    replayed = Replay(RunFile(recording)).run()
    assert replayed.difference is None
    assert replayed.time_s > 10.0
    assert not replayed.is_cut_off


def pick(*parameters: str) -> subprocess.CompletedProcess[str]:
    """Run the node until it ends."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    return subprocess.run(
        [Path(sys.executable).with_name("mycobot_pick_and_place"), "--ros-args", *words],
        env=os.environ,
        capture_output=True,
        text=True,
        timeout=PICK_TIMEOUT_S,
    )
