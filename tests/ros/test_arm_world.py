"""The world without controllers, another update rate, and an error of the simulation node."""

from pathlib import Path

import numpy as np
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from simulated import PAUSED, PLAYING, Simulated


def write_controllers(folder: Path, update_rate: int) -> Path:
    path = folder / "controllers.yaml"
    path.write_text(f"""\
controller_manager:
  ros__parameters:
    update_rate: {update_rate}
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    position_controller:
      type: position_controllers/JointGroupPositionController
position_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
""")
    return path


def test_the_arm_falls_without_position_hold(launch, client):
    launched = launch(
        "arm_gazebo",
        "arm_gazebo.launch.py",
        "camera:=none",
        "hold_joints:=false",
        "spawn:=joint_state_broadcaster",
        "j1_pos:=0.5",
        "j2_pos:=0.5",
    )
    launched.wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    fallen = states.wait_until(
        lambda m: bool(m) and abs(m[-1].position[1]) > 1.2, "the arm lies on the floor"
    )
    assert abs(fallen[-1].position[1]) > 1.2


def test_unclaimed_joints_hold_the_initial_pose_at_a_rate_that_no_step_divides(
    launch, client, tmp_path
):
    rate_hz = 225  # The original's.

    path = write_controllers(tmp_path, rate_hz)
    pose = ("j1_pos:=0.5", "j2_pos:=0.5", "j3_pos:=1.0")
    spawned = "spawn:=joint_state_broadcaster"
    launch("camera:=none", f"controllers:={path}", spawned, *pose).wait_until_ready()
    states = client.subscribe(JointState, "/joint_states").wait_for(2 * rate_hz)
    stamps = np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in states])
    assert np.median(np.diff(stamps)) == pytest.approx(1 / rate_hz, rel=1e-3)
    assert np.allclose([m.position for m in states], [0.0, 0.5, 0.5, 1.0], atol=0.01)


def test_what_the_node_refuses_ends_the_launch_with_its_sentence(launch):
    launched = launch("camera:=none", "physics_step:=0.003")
    output = launched.fail()
    assert "0.003" in output
    assert "0.01" in output


def test_a_paused_start_waits_for_play(launch, client):
    clock = client.subscribe(Clock, "/clock")
    launch("arm_gazebo", "arm_world.launch.py", "camera:=none", "paused:=true").wait_until_ready()
    simulation = Simulated(client)
    assert simulation.state() == PAUSED
    assert {(m.clock.sec, m.clock.nanosec) for m in clock.messages} <= {(0, 0)}
    simulation.go_to(PLAYING)
    clock.wait_until(lambda messages: messages and messages[-1].clock.nanosec > 0, "time goes on")
