"""A run over ROS is recorded, and runs again to the last bit, without ROS."""

import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from programs import RosProgram
from sensor_msgs.msg import JointState
from simulated import Simulated
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile

TIMEOUT_S = 60.0


def arm(*words: str) -> RosProgram:
    """Start a verb of `arm`."""
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    return RosProgram([sys.executable, "-m", "arm_cli", *words], environment)


@contextmanager
def record_verb(path: Path) -> Iterator[RosProgram]:
    """Record with `arm sim record`, and make sure that it is gone afterwards."""
    verb = arm("sim", "record", str(path))
    try:
        verb.wait_for_line("recording to")
        yield verb
    finally:
        verb.close()


def move(client, commands, states, *positions: float) -> None:
    """Command the arm, and wait until it is there."""
    commands.publish(Float64MultiArray(data=list(positions)))
    states.wait_until(
        lambda m: bool(m) and abs(m[-1].position[0] - positions[0]) < 0.01, "the arm there"
    )


def states_of(client):
    return client.subscribe(JointState, "/joint_states")


def test_a_launch_is_recorded_from_its_start_also_if_the_simulation_is_killed(
    launch, client, tmp_path
):
    path = tmp_path / "killed.run"
    running = launch(f"record_run:={path}", "camera:=none")
    running.wait_until_ready()
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    states = states_of(client)
    move(client, commands, states, 0.5, 0.2, 0.1, 0.3)
    stamp = states.wait_for()[-1].header.stamp
    moved_s = stamp.sec + stamp.nanosec * 1e-9
    deadline = time.monotonic() + TIMEOUT_S
    while Replay(RunFile(path)).run().time_s < moved_s:
        assert time.monotonic() < deadline, "the file is not written any more"
    (simulation,) = running.processes("arm_gazebo_node")
    simulation.kill()
    running.wait()
    result = Replay(RunFile(path)).run()
    assert result.difference is None
    assert result.is_cut_off
    assert result.time_s >= moved_s


def test_a_recording_is_refused_in_a_sentence_and_begins_and_ends_by_a_parameter(
    launch, client, tmp_path
):
    def record_to(file) -> str:
        return simulation.set(record_run=str(file))

    simulation, path = Simulated(client), tmp_path / "middle.run"
    launch("camera:=none").wait_until_ready()
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    states = states_of(client)
    move(client, commands, states, 0.3, 0.2, 0.1, 0.3)
    assert "No such file or directory" in record_to(tmp_path / "none" / "a.run")
    assert record_to(path) == ""
    assert f"a recording to {path} is still running" in record_to(tmp_path / "other.run")
    move(client, commands, states, -0.5, 0.2, 0.1, 0.3)
    for is_engaged in (True, False):
        client.call(SetBool, "/emergency_stop", SetBool.Request(data=is_engaged))
    # Also the clock goes back to 0.
    simulation.reset()
    move(client, commands, states, 0.4, 0.2, 0.1, 0.3)
    assert record_to("") == ""
    assert f"{path} exists already" in record_to(path)
    result = Replay(RunFile(path)).run()
    assert result.difference is None
    assert not result.is_cut_off
    assert result.periods > 20

    with record_verb(tmp_path / "verb.run") as verb:
        move(client, commands, states, 0.5, 0.2, 0.1, 0.3)
        assert verb.stop() == 0
        assert "control periods in" in verb.output
    replay = arm("sim", "replay", str(tmp_path / "verb.run"))
    assert "control periods are equal" in replay.succeed()
    replay.close()


@pytest.mark.parametrize("is_gone", [True, False], ids=["before", "meanwhile"])
def test_a_recording_ends_with_its_simulation(simulate, tmp_path, is_gone):
    model = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    running = simulate(
        {"arm_gazebo": {"robot_description": expand_xacro(model, {"camera": "none"})}}
    )
    with record_verb(tmp_path / "a.run") as verb:
        running.process.send_signal(signal.SIGINT)
        if is_gone:
            running.wait()
        assert verb.stop() == 0
        assert "control periods in" in verb.output
