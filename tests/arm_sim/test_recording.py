"""A run of the library is recorded, and runs again to the same bits."""

import pytest
from robots import CAN

from arm_gazebo.errors import RecordingError
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim import CallError, Simulation

ARM = {"arguments": {"camera": "none"}}


def test_a_recorded_run_replays_with_equal_states(tmp_path):
    with Simulation("arm", record=tmp_path / "arm.run", **ARM) as sim:
        sim["position_controller"].command([0.4, 0.3, 0.2, 0.1])
        sim.run(0.5)
        sim.spawn(CAN, pose=(0.6, 0.2, 0.1))
        sim.controllers.load("joint_trajectory_controller")
        sim.controllers.switch(["joint_trajectory_controller"], ["position_controller"])
        sim.follow(
            "joint_trajectory_controller", {"times_s": [0.5], "positions": [[0.0, 0.2, 0.2, 0.1]]}
        )
    result = Replay(RunFile(tmp_path / "arm.run")).run()
    assert result.difference is None
    assert not result.is_cut_off
    assert result.periods >= 100


def test_a_file_that_exists_is_not_overwritten(tmp_path):
    (tmp_path / "arm.run").touch()
    with pytest.raises(RecordingError, match="exists already"):
        Simulation("arm", record=tmp_path / "arm.run", **ARM)


def test_a_recording_says_that_the_program_failed(tmp_path):
    with pytest.raises(CallError), Simulation("arm", record=tmp_path / "arm.run", **ARM) as sim:
        sim.run(-1.0)
    assert Replay(RunFile(tmp_path / "arm.run")).run().end_reason == "the program failed"


def test_a_recording_begins_in_the_middle_and_may_go_back(sim, tmp_path):
    sim["position_controller"].command([0.4, 0.3, 0.2, 0.1])
    sim.run(0.2)
    with sim.record(tmp_path / "arm.run"):
        here = sim.save()
        sim.run(0.3)
        sim.spawn(CAN, pose=(0.6, 0.2, 0.1))
        sim.run(0.2)
        sim.restore(here)
        sim.run(0.3)
        sim.reset()
        sim["position_controller"].command([0.1, 0.1, 0.1, 0.1])
        sim.run(0.2)
    sim.run(0.1)
    result = Replay(RunFile(tmp_path / "arm.run")).run()
    assert result.difference is None
    assert result.periods == 100
