"""The world without controllers, other update rates, and the errors of the simulation node."""

import os
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.ros


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
    from sensor_msgs.msg import JointState

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


def test_unclaimed_joints_hold_the_initial_pose_by_default(launch, client):
    from sensor_msgs.msg import JointState

    pose = ("j1_pos:=0.5", "j2_pos:=0.5", "j3_pos:=1.0")
    launch("camera:=none", "spawn:=joint_state_broadcaster", *pose).wait_until_ready()
    states = client.subscribe(JointState, "/joint_states").wait_for(200)
    assert np.allclose([m.position for m in states], [0.0, 0.5, 0.5, 1.0], atol=0.01)


def test_an_update_rate_that_no_step_divides_works(launch, client, tmp_path):
    from sensor_msgs.msg import JointState

    rate_hz = 225  # The original's.

    path = write_controllers(tmp_path, rate_hz)
    launch("camera:=none", f"controllers:={path}").wait_until_ready()
    states = client.subscribe(JointState, "/joint_states").wait_for(2 * rate_hz)
    stamps = np.array([m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in states])
    assert np.median(np.diff(stamps)) == pytest.approx(1 / rate_hz, rel=1e-3)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["physics_step:=0.003"], ["0.003", "0.01"]),
        (["headless:=false"], ["DISPLAY is not set", "headless:=false"]),
        (["gz_args:=-r -v 1 kitchen.sdf"], ["'kitchen'", "empty", "objects"]),
        (["gz_args:=-r objects.sdf", "world:=/no/such/lab.xml"], ["/no/such/lab.xml", "empty"]),
    ],
)
def test_invalid_requests_are_refused_with_a_sentence(launch, arguments, words):
    launched = launch("camera:=none", *arguments, DISPLAY="", WAYLAND_DISPLAY="")
    assert launched.wait() != 0
    assert "Traceback" not in launched.output
    for word in words:
        assert word in launched.output


def test_gazebo_s_arguments_reach_the_simulation(launch):
    launched = launch("arm_gazebo", "arm_gazebo.launch.py", "gz_args:=-r -v 1 empty.sdf", "--print")
    assert launched.wait() == 0, launched.output
    assert "--log-level error" in launched.output


def test_a_paused_start_waits_for_play(launch, client):
    from rosgraph_msgs.msg import Clock
    from simulation_interfaces.msg import SimulationState
    from simulation_interfaces.srv import GetSimulationState, SetSimulationState

    clock = client.subscribe(Clock, "/clock")
    launch("arm_gazebo", "arm_world.launch.py", "camera:=none", "paused:=true").wait_until_ready()
    answer = client.call(GetSimulationState, "/get_simulation_state", GetSimulationState.Request())
    assert answer.state.state == SimulationState.STATE_PAUSED
    assert {(m.clock.sec, m.clock.nanosec) for m in clock.messages} <= {(0, 0)}
    playing = SimulationState(state=SimulationState.STATE_PLAYING)
    client.call(
        SetSimulationState, "/set_simulation_state", SetSimulationState.Request(state=playing)
    )
    clock.wait_until(lambda messages: messages and messages[-1].clock.nanosec > 0, "time goes on")


def test_rviz_opens_if_installed(launch, tmp_path):
    program = tmp_path / "rviz2"
    program.write_text("#!/bin/sh\necho shows $*\n")
    program.chmod(0o755)
    launched = launch(
        *("arm_gazebo", "arm_world.launch.py", "camera:=none"),
        *("use_rviz:=true", "rviz_config_file:=/my/lab.rviz"),
        PATH=f"{tmp_path}:{os.environ['PATH']}",
    )
    launched.wait_for_line("shows -d /my/lab.rviz --ros-args -p use_sim_time:=true")
    launched.wait_until_ready()
    assert launched.stop() == 0, launched.output
