import functools
import math
import struct
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from robots import crate

from arm_control.controllers.joint_trajectory.goals import GoalRequest
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.errors import ControllerManagerError
from arm_gazebo.errors import ModelError, RecordingError
from arm_gazebo.recording.replay import Replay, differing
from arm_gazebo.recording.run_file import RecordedInput, RunFile, RunFileWriter

FORWARD = "position_controllers/JointGroupPositionController"
TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
JOINTS = ("j0", "j1", "j2", "j3")
CRATE = crate()
BALL = """<mujoco><worldbody><body><freejoint/><geom size="0.05" mass="0.1"/></body></worldbody>
  </mujoco>"""


def goal(name: bytes, positions, time_s: float) -> GoalRequest:
    """Return a goal for the 4-DOF arm."""
    return GoalRequest(name, TrajectoryRequest(JOINTS, [TrajectoryPoint(time_s, positions)]))


def at(x: float, y: float, z: float) -> np.ndarray:
    """Return a pose (4, 4) without a turn."""
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def rewritten(path, change):
    """Write a copy of a recording with each input changed by a function; return its path."""
    file, new = RunFile(path), path.with_suffix(".changed")
    header = {key: value for key, value in file.header.items() if key != "format"}
    writer = RunFileWriter(new, header)
    for record in file.records():
        writer.write(change(record) if isinstance(record, RecordedInput) else record)
    writer.close()
    return new


def saved_by(path, version: int):
    """Write a copy of a recording whose model another version of MuJoCo saved; return its path."""
    file, new = RunFile(path), path.with_suffix(".other")
    header = {key: value for key, value in file.header.items() if key != "format"}
    model = header["run"].model
    content = bytearray(model.content)
    struct.pack_into("=i", content, 12, version)
    header["run"] = replace(header["run"], model=replace(model, content=bytes(content)))
    writer = RunFileWriter(new, header)
    for record in file.records():
        writer.write(record)
    writer.close()
    return new


@pytest.mark.workaround("patch_releases")
def test_a_recording_of_another_patch_release_of_mujoco_repeats(recorded, parts):
    run = recorded(parts.pendulum())
    run.run(3)
    other = saved_by(run.finish(), mujoco.mj_version() + 1)
    assert Replay(RunFile(other)).run().difference is None


def test_a_recording_of_another_release_of_mujoco_is_refused_with_both_versions(recorded, parts):
    run = recorded(parts.pendulum())
    run.run(3)
    other = saved_by(run.finish(), 4_099_000)
    here = mujoco.__version__
    with pytest.raises(
        ModelError, match=f"MuJoCo {here} cannot read the model that MuJoCo 4.99.0 saved"
    ):
        Replay(RunFile(other))


def test_a_run_of_commands_repeats_to_the_last_bit(recorded, replayed, parts):
    run = recorded(parts.pendulum())
    run.run(3)
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    for position in np.random.default_rng(0).uniform(-1.0, 1.0, 20):
        controller.offer([position])
        run.run(7)
    result = replayed(run.finish())
    assert result.difference is None
    assert result.periods == run.recorder.periods == 143
    assert not result.is_cut_off
    assert result.time_s == pytest.approx(1.43)


def test_goals_cancellations_and_switches_repeat(recorded, replayed, parts):
    run = recorded(parts.arm())
    arm = run.start_controller(
        "arm",
        TRAJECTORY,
        joints=JOINTS,
        command_interfaces=("position",),
        state_interfaces=("position", "velocity"),
    )
    run.run(5)
    arm.submit_goal(goal(b"first", (0.5, 0.3, -0.2, 0.1), 1.0))
    arm.serve_requests()
    run.run(30)
    arm.submit_goal(goal(b"second", (-0.5, 0.0, 0.2, 0.3), 0.5))
    run.run(20)
    arm.cancel_goal(b"second")
    run.run(20)
    run.switch(deactivate=("arm",))
    run.run(10)
    run.switch(activate=("arm",))
    arm.submit_trajectory(goal(b"", (0.1, 0.1, 0.1, 0.1), 0.2).trajectory)
    run.run(40)
    moved = run.simulation.data.qpos.copy()
    result = replayed(run.finish())
    assert result.difference is None
    assert result.periods == 125
    assert np.abs(moved).max() > 0.05


def test_things_that_come_move_and_go_repeat(recorded, replayed, parts):
    run = recorded(parts.arm(), world="objects")
    run.run(5)
    run.spawn("crate", CRATE, at(1.0, 0.0, 0.3))
    run.run(30)
    run.editor.place("crate", at(1.0, 0.2, 0.5), "", None)
    run.run(30)
    run.spawn("ball", BALL, at(1.0, 0.2, 0.9))
    run.run(30)
    run.editor.delete("crate")
    run.run(20)
    run.editor.undo(True, True, lambda: run.state.reset(clock=True))
    run.run(20)
    result = replayed(run.finish())
    assert result.difference is None
    assert result.periods == 135


def test_a_restored_snapshot_repeats(recorded, replayed, parts):
    run = recorded(parts.arm(), world="objects")
    pos = run.start_controller("pos", FORWARD, joints=("j0", "j1", "j2", "j3"))
    pos.offer([0.5, 0.3, 0.2, 0.1])
    run.run(20)
    saved = run.state.save()
    pos.offer([-0.5, 0.0, 0.0, 0.0])
    run.run(30)
    run.state.restore(saved)
    run.run(40)
    run.state.set_clock(100.0)
    run.run(10)
    result = replayed(run.finish())
    assert result.difference is None
    assert result.periods == 100


def test_changed_parameters_repeat(recorded, replayed, parts):
    run = recorded(parts.arm())
    arm = run.start_controller(
        "arm",
        TRAJECTORY,
        joints=JOINTS,
        command_interfaces=("position",),
        state_interfaces=("position",),
    )
    arm.change_parameters(replace(run.parameters["arm"], allow_partial_joints_goal=True))
    request = TrajectoryRequest(("j1",), [TrajectoryPoint(0.3, (0.4,))])
    assert arm.submit_trajectory(request) is None
    run.run(40)
    assert replayed(run.finish()).difference is None


def test_an_input_that_was_refused_must_be_refused_again(recorded, replayed, parts):
    run = recorded(parts.pendulum())
    with pytest.raises(ControllerManagerError):
        run.manager.cleanup_controller("nobody")
    run.run(3)
    path = run.finish()
    assert replayed(path).difference is None
    accepted = rewritten(path, lambda record: replace(record, raised=False))
    difference = replayed(accepted).difference
    assert difference is not None
    assert "input cleanup_controller was accepted, but is refused: Could not" in difference.lines[0]


def test_until_stops_at_that_time_and_goes_on_from_there(recorded, parts):
    run = recorded(parts.pendulum())
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    controller.offer([0.5])
    run.run(50)
    replay = Replay(RunFile(run.finish()))
    half = replay.run(until_s=0.25)
    assert half.time_s == pytest.approx(0.25)
    assert half.periods == 25
    assert half.difference is None
    assert not half.is_cut_off


def test_every_period_that_is_equal_is_told(recorded, parts):
    run = recorded(parts.pendulum())
    run.run(4)
    times = []
    replay = Replay(RunFile(run.finish()))
    replay.run(after_period=lambda: times.append(replay.simulation.time_s))
    assert times == pytest.approx([0.01, 0.02, 0.03, 0.04])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "__init__"}, "no input '__init__'"),
        ({"method": "add_observer"}, "no input 'add_observer'"),
        ({"method": "offer", "controller": "nobody"}, "no input 'offer' of nobody"),
        ({"robot": 3}, "no robot number 3"),
        ({"robot": None, "method": "advance"}, "no input 'advance' of the simulation"),
    ],
)
def test_a_file_can_call_nothing_but_inputs(recorded, replayed, parts, change, message):
    run = recorded(parts.pendulum())
    run.start_controller("pos", FORWARD, joints=("j",))
    run.run(2)
    path = rewritten(run.finish(), lambda record: replace(record, **change))
    difference = replayed(path).difference
    assert difference is not None
    assert message in difference.lines[0]


def test_a_method_with_another_decorator_is_no_input(recorded, replayed, parts, monkeypatch):
    def logged(method):
        @functools.wraps(method)
        def call(self, *args, **kwargs):
            return method(self, *args, **kwargs)

        return call

    def forget(self, values):
        raise AssertionError("a recording has called it")

    run = recorded(parts.pendulum())
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    controller.offer([0.5])
    run.run(2)
    monkeypatch.setattr(type(controller), "forget", logged(forget), raising=False)

    def change(record: RecordedInput) -> RecordedInput:
        return replace(record, method="forget") if record.method == "offer" else record

    difference = replayed(rewritten(run.finish(), change)).difference
    assert difference is not None
    assert "no input 'forget' of pos" in difference.lines[0]


def test_a_recording_without_a_run_is_a_sentence(tmp_path):
    writer = RunFileWriter(tmp_path / "empty.run", {"made_with": {}})
    writer.close()
    with pytest.raises(RecordingError, match="does not say how to build its run"):
        Replay(RunFile(tmp_path / "empty.run"))


def test_commands_come_first_among_the_differences():
    lines = differing(["position", "command a"], np.zeros(2), np.array([9.0, 0.1]))
    assert [line.partition(":")[0] for line in lines] == ["command a", "position"]


def test_the_largest_differences_come_first_and_nan_is_equal_to_nan():
    names = [f"n{i}" for i in range(9)]
    before = np.array([0.0, math.nan, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])
    after = before + np.array([0.1, 0.0, 0.0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    lines = differing(names, before, after)
    named = [line.partition(":")[0] for line in lines]
    assert named == ["n8", "n7", "n6", "n5", "n4", "n3", "and 1 more numbers"]
    unknown = differing(names[:1], np.array([math.nan]), np.array([1.0]))
    assert unknown[0].startswith("n0: 1.0 instead of nan")
