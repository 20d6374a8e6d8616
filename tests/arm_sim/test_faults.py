"""Faults on demand in the library."""

import logging
import time
from math import isnan, nan

import numpy as np
import pytest
from robots import pendulum, sensor

from arm_gazebo.errors import FaultError
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim.bench.simulation import BenchSimulation
from arm_sim.errors import CallError, UnknownNameError

GOAL = [1.0, 0.5, 0.1, 0.5]
IMU = pendulum(sensor("bob", "imu", "imu"), name="box", xyz="0 0 0")


@pytest.fixture
def sim():
    with BenchSimulation(robot="arm", arguments={"camera": "none"}) as simulation:
        yield simulation


def test_a_stalled_joint_stays_where_it_is_and_moves_again_afterwards(sim):
    with sim.faults.joint_stalled("j1"):
        sim["position_controller"].command(GOAL)
        sim.assert_reaches({"j0": 1.0, "j2": 0.1, "j3": 0.5})
        assert sim.joints["j1"].position == pytest.approx(0.0, abs=1e-3)
        with pytest.raises(AssertionError, match=r"fault: j1 joint stalled, from 0\.000 s"):
            sim.assert_reaches(GOAL, within_s=0.5)
    sim.assert_reaches(GOAL, within_s=2.0)


def test_a_stalled_joint_still_sticks_when_the_world_changes(sim):
    body = '<body name="b"><freejoint/><geom size="0.1"/></body>'
    ball = f"<mujoco><worldbody>{body}</worldbody></mujoco>"
    with sim.faults.joint_stalled("j0"):
        sim.spawn(ball, name="ball", pose=[2.0, 0.0, 0.1])
        sim["position_controller"].command(GOAL)
        sim.run(0.5)
        assert sim.joints["j0"].position == pytest.approx(0.0, abs=1e-3)
    sim.assert_reaches(GOAL, within_s=2.0)


def test_a_fault_lasts_when_the_simulation_is_reset(sim):
    sim.run(0.1)
    with sim.faults.joint_stalled("j1"):
        sim.run(0.1)
        sim.reset()
        sim["position_controller"].command(GOAL)
        with pytest.raises(AssertionError, match=r"fault: j1 joint stalled, from 0\.000 s"):
            sim.assert_reaches(GOAL, within_s=0.5)
    sim.assert_reaches(GOAL, within_s=2.0)
    (span,) = sim.faults.log.spans
    assert span.ended_s == pytest.approx(0.5)


def test_a_frozen_sensor_keeps_its_reading(sim):
    sim["position_controller"].command(GOAL)
    sim.run(0.1)
    with sim.faults.sensor_frozen("j0/position"):
        sim.step()
        frozen = sim.states["j0/position"]
        sim.run(0.5)
        assert sim.states["j0/position"] == frozen < 0.3
        assert sim.states["j1/position"] == sim.joints["j1"].position
        assert sim.joints["j0"].position > 0.9
    sim.step()
    assert sim.states["j0/position"] == sim.joints["j0"].position


def test_a_sensor_reads_nan(sim):
    with sim.faults.sensor_nan("j2"):
        sim.step()
        assert [name for name, value in sim.states.items() if isnan(value)] == [
            "j2/position", "j2/velocity", "j2/effort",
        ]  # fmt: skip
    sim.step()
    assert not any(map(isnan, sim.states.values()))


def test_a_sensor_of_gazebo_can_be_wrong_in_one_channel(tmp_path):
    (tmp_path / "box.urdf").write_text(IMU)
    with BenchSimulation(robot=tmp_path / "box.urdf") as sim:
        with sim.faults.sensor_nan("imu/linear_acceleration.z"):
            sim.step()
            assert isnan(sim.sensors["imu"]["linear_acceleration.z"])
            assert sim.sensors["imu"]["linear_acceleration.x"] == pytest.approx(0.0, abs=0.1)
        assert sim.sensors["imu"]["linear_acceleration.z"] == pytest.approx(9.81, abs=0.1)


def noise(sim: BenchSimulation, seed: int, name: str = "j0") -> list[float]:
    found = []
    with sim.faults.sensor_noisy(name, 0.1, seed):
        for _ in range(200):
            sim.step()
            found.append(sim.states["j0/position"] - sim.joints["j0"].position)
    return found


def test_a_noisy_sensor_has_the_deviation_that_was_asked_for(sim):
    found = noise(sim, 3)
    assert np.std(found) == pytest.approx(0.1, rel=0.2)
    assert np.mean(found) == pytest.approx(0.0, abs=0.03)


def test_noise_repeats_with_its_seed():
    runs = []
    for seed, name in ((3, "j0"), (3, "j0/position"), (4, "j0")):
        with BenchSimulation(robot="arm", arguments={"camera": "none"}) as sim:
            runs.append(noise(sim, seed, name))
    assert runs[0] == runs[1] != runs[2]


def test_a_controller_that_raises_is_stopped_each_time(sim, caplog):
    controller = sim["position_controller"]
    with caplog.at_level(logging.ERROR), sim.faults.controller_raises("position_controller"):
        assert not controller.is_active
        sim.controllers.switch(["position_controller"])
        assert controller.is_active
        sim.step()
        assert not controller.is_active
    assert "controller 'position_controller' raised in its update" in caplog.text
    sim.controllers.switch(["position_controller"])
    sim.step()
    assert controller.is_active


def test_a_slow_tick_takes_longer(sim):
    with sim.faults.slow_tick(0.01):
        began_s = time.monotonic()
        sim.run(10 * sim.period_s)
        assert time.monotonic() - began_s >= 0.1


def test_lost_commands_do_not_move_the_robot(sim):
    with sim.faults.messages_dropped("position_controller"):
        sim["position_controller"].command(GOAL)
        sim.run(0.2)
        assert sim.joints.position == pytest.approx(np.zeros(4), abs=1e-6)
    sim["position_controller"].command(GOAL)
    sim.assert_reaches(GOAL)


def test_a_delayed_command_takes_effect_later(sim):
    with sim.faults.messages_delayed("position_controller", by_s=0.5):
        sim["position_controller"].command(GOAL)
        sim.run(0.5)
        assert sim.joints["j0"].position == pytest.approx(0.0, abs=1e-6)
        sim.step()
        assert sim.joints["j0"].position > 1e-5


def test_a_second_copy_comes_after_later_commands(sim):
    with sim.faults.messages_doubled("position_controller", after_s=1.0):
        sim["position_controller"].command(GOAL)
        sim.run(0.5)
        sim["position_controller"].command([0.0] * 4)
        sim.run(0.5)
        assert sim.joints["j0"].position < 0.5
        sim.run(0.45)
        assert sim.joints["j0"].position > 0.6


def test_a_dark_camera_sees_nothing():
    with BenchSimulation(robot="arm", render_backend="raycast") as sim:
        name = sim.cameras[0]
        with sim.faults.camera_dark(name):
            assert not sim.camera(name).image().any()
            assert (sim.camera(name).depth() == -np.inf).all()
        assert sim.camera(name).image().any()


@pytest.mark.parametrize(
    ("fault", "arguments", "sentence"),
    [
        ("joint_stalled", ["j9"], "no joint 'j9'; there are j0, j1, j2, j3"),
        ("sensor_nan", ["imu"], "no joint, sensor or channel 'imu'; there are j0"),
        ("controller_raises", ["c"], "no controller 'c'"),
        ("messages_dropped", ["c"], "no controller 'c'"),
        ("sensor_noisy", ["j0", nan], "needs a positive number"),
        ("messages_dropped", ["position_controller", 2.0], "fraction"),
        ("camera_dark", ["c"], "no camera 'c'"),
    ],
)
def test_a_fault_of_something_that_is_not_there_is_refused(sim, fault, arguments, sentence):
    with (
        pytest.raises((FaultError, CallError, UnknownNameError), match=sentence),
        getattr(sim.faults, fault)(*arguments),
    ):
        pass


def test_a_recording_of_a_run_with_faults_replays(tmp_path):
    file = tmp_path / "faults.run"
    with BenchSimulation(robot="arm", arguments={"camera": "none"}, record=file) as sim:
        with (
            sim.faults.joint_stalled("j1"),
            sim.faults.sensor_noisy("j0", 0.01, 5),
            sim.faults.sensor_frozen("j2"),
            sim.faults.messages_delayed("position_controller", 0.1),
        ):
            sim["position_controller"].command(GOAL)
            sim.run(0.5)
        with sim.faults.controller_raises("position_controller"):
            sim.run(0.2)
    result = Replay(RunFile(file)).run()
    assert result.difference is None
    assert result.periods == 70


@pytest.mark.parametrize("again", ["reset", "restore"])
def test_a_recording_that_begins_while_faults_last_has_them(sim, again, tmp_path):
    saved = sim.save()
    with (
        sim.faults.joint_stalled("j1"),
        sim.faults.sensor_frozen("j2"),
        sim.faults.sensor_noisy("j0", 0.01, 5),
    ):
        sim["position_controller"].command(GOAL)
        sim.run(0.3)
        _ = sim.reset(sim.first_seed) if again == "reset" else sim.restore(saved)
        sim["position_controller"].command(GOAL)
        sim.run(0.2)
        list(sim.report(tmp_path))
    sim.close()
    replay = Replay(RunFile(tmp_path / "test.run"))
    assert replay.run().difference is None
    assert replay.simulation.faults.present is not None
