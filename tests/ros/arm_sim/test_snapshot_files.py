"""The node and the library restore each other's snapshots."""

import subprocess
import sys

import numpy as np
from sensor_msgs.msg import JointState

from arm_sim import Simulation

POSE = [1.0, 0.5, 0.1, 0.5]


def arm_sim_verb(*words: str) -> str:
    """Run `arm sim WORDS`; return what it prints."""
    command = [sys.executable, "-m", "arm_cli", "sim", *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_state_goes_from_the_library_to_the_node_and_back(launch, client, tmp_path):
    first, second = tmp_path / "library.snapshot", tmp_path / "node.snapshot"
    with Simulation("arm") as sim:
        sim["position_controller"].command(POSE)
        sim.run(2.0)
        sim.save(first)
        time_s, positions = sim.time_s, sim.joints.position
    launch("arm_gazebo", "arm_gazebo.launch.py", "paused:=true").wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    # The restored state is published once.
    client.be_known_to_server("/get_simulation_state")
    arm_sim_verb("restore", str(first))
    there = states.wait_until(
        lambda m: bool(m) and list(m[-1].position) == positions.tolist(), "the library's state"
    )
    assert there[-1].header.stamp.sec == round(time_s)
    arm_sim_verb("save", str(second))
    with Simulation("arm") as sim:
        sim.restore(second)
        assert sim.time_s == time_s
        assert np.array_equal(sim.joints.position, positions)
