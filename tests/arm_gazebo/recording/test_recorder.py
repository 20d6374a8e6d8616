import time

import numpy as np

from arm_gazebo.recording import recorder as recorder_module
from arm_gazebo.recording.run_file import RecordedInput, RunFile, StateBlock

FORWARD = "position_controllers/JointGroupPositionController"


def blocks(path) -> list[StateBlock]:
    return [record for record in RunFile(path).records() if isinstance(record, StateBlock)]


def test_inputs_are_noted_with_the_period_before_which_they_take_effect(recorded, parts):
    run = recorded(parts.pendulum())
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    run.run(2)
    controller.offer([0.5])
    run.run(3)
    run.state.reset(clock=False)
    inputs = [r for r in RunFile(run.finish()).records() if isinstance(r, RecordedInput)]
    assert [(i.period, i.robot, i.controller, i.method) for i in inputs] == [
        (0, 0, None, "load_controller"),
        (0, 0, None, "configure_controller"),
        (0, 0, None, "switch_controller"),
        (2, 0, "pos", "offer"),
        (5, None, None, "reset"),
    ]


def test_after_the_end_nothing_is_noted(recorded, parts):
    run = recorded(parts.pendulum())
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    run.run(3)
    path = run.finish()
    size = path.stat().st_size
    controller.offer([0.5])
    run.run(3)
    assert path.stat().st_size == size
    assert controller.input_gate is None


def test_states_are_stored_in_blocks_without_a_gap(recorded, parts, monkeypatch):
    monkeypatch.setattr(recorder_module, "MAX_PERIODS", 50)
    monkeypatch.setattr(recorder_module, "FLUSH_S", 3600.0)
    run = recorded(parts.pendulum())
    run.run(120)
    found = blocks(run.finish())
    assert [(block.first, len(block.hashes)) for block in found] == [(0, 50), (50, 50), (100, 20)]
    assert [len(block.states) for block in found] == [50, 50, 20]
    times_s = np.concatenate([block.states[:, 0] for block in found])
    np.testing.assert_allclose(times_s, np.arange(1, 121) / 100)


def test_recorded_states_are_flushed_after_half_a_second(recorded, parts):
    run = recorded(parts.pendulum())
    deadline_s = time.monotonic() + 30.0
    while not blocks(run.path):
        assert time.monotonic() < deadline_s
        run.run(1)
        time.sleep(0.01)
    flushed = sum(len(block.hashes) for block in blocks(run.path))
    assert 0 < flushed <= run.recorder.periods < 2000
    run.run(20)
    # What was flushed before its block was full is followed by the rest of that block.
    found = blocks(run.finish())
    ends = [block.first + len(block.hashes) for block in found]
    assert [block.first for block in found] == [0, *ends[:-1]]
    assert ends[-1] == run.recorder.periods


def test_only_a_full_block_wakes_the_writing_thread(recorded, parts, monkeypatch):
    monkeypatch.setattr(recorder_module, "MAX_PERIODS", 50)
    monkeypatch.setattr(recorder_module, "FLUSH_S", 3600.0)
    run = recorded(parts.pendulum())
    controller = run.start_controller("pos", FORWARD, joints=("j",))
    run.run(49)
    controller.offer([0.5])
    assert not blocks(run.path)
    run.run(1)
    deadline_s = time.monotonic() + 30.0
    while not blocks(run.path):
        assert time.monotonic() < deadline_s
        time.sleep(0.01)
    run.finish()


def test_of_large_states_some_are_stored_and_all_are_hashed(recorded, replayed, parts, monkeypatch):
    monkeypatch.setattr(recorder_module, "MAX_BYTES_PER_S", 5000)
    monkeypatch.setattr(recorder_module, "FLUSH_S", 3600.0)
    run = recorded(parts.pendulum())
    run.run(50)
    path = run.finish()
    (block,) = blocks(path)
    assert block.interval > 1
    assert len(block.hashes) == 50
    assert len(block.states) == -(-50 // block.interval)
    assert replayed(path).difference is None


def test_a_full_disk_ends_the_recording_and_not_the_run(recorded, replayed, parts, monkeypatch):
    run = recorded(parts.pendulum())
    run.run(60)

    def fail(_record) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(run.recorder._writer, "write", fail)
    run.run(300)
    time_s = run.simulation.time_s
    run.finish()
    assert time_s > 3.5
    assert "No space left on device" in run.recorder.failure
    assert str(run.path) in run.recorder.failure


def test_an_argument_that_is_not_data_ends_the_recording_and_is_named(recorded, parts):
    run = recorded(parts.pendulum())
    run.recorder.give(run.manager, "odd", {"thing": object()}, lambda: None)
    run.run(3)
    run.finish()
    assert "the input.arguments.thing is a builtins.object" in run.recorder.failure
