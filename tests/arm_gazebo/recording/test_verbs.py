"""`arm sim replay` and `arm sim diff` on recordings."""

import functools
from pathlib import Path

import pytest

from arm_cli.main import main
from arm_gazebo.recording.run_file import RecordingEnd, RunFile

FORWARD = "position_controllers/JointGroupPositionController"


@pytest.fixture
def swung(recorded, parts):
    """Return a function that records a pendulum that is given a command; returns the path."""

    def swing(name: str = "a.run", command: float = 0.5, periods: int = 30) -> str:
        run = recorded(parts.pendulum(), name)
        controller = run.start_controller("pos", FORWARD, joints=("j",))
        run.run(10)
        controller.offer([command])
        run.run(periods - 10)
        return str(run.finish())

    return swing


def test_a_replay_that_is_equal_says_so_and_exits_0(swung, capsys):
    assert main(["sim", "replay", swung()]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("30 control periods are equal, up to 0.300 s (replayed in ")
    assert printed.count("\n") == 1


def test_inputs_are_printed_with_their_times(swung, capsys):
    assert main(["sim", "replay", swung(), "--inputs"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("0.000 s: load_controller controller=pos type_name=position_contr")
    assert lines[3] == "0.100 s: pos offer values=[0.5]"


def test_until_stops_there_and_prints_the_joints(swung, capsys):
    assert main(["sim", "replay", swung(), "--until", "0.2"]) == 0
    printed = capsys.readouterr().out
    assert "20 control periods are equal, up to 0.200 s" in printed
    assert "joints at 0.200 s:\n  j: position " in printed


def test_a_replay_that_differs_names_the_period_and_exits_1(swung, capsys, monkeypatch):
    path = swung()
    # A controller with a fault that it did not have when the run was recorded.
    monkeypatch.setattr(
        "arm_control.controllers.forward_command.controller.ForwardCommander.offer",
        _doubled("arm_control.controllers.forward_command.controller"),
    )
    assert main(["sim", "replay", path]) == 1
    printed = capsys.readouterr().out
    assert "control period 10, at 0.110 s, differs:" in printed
    assert "command j/position of /controller_manager: 1.0 instead of 0.5, by 0.5" in printed
    assert "the first 10 control periods are equal" in printed


def _doubled(module_name: str):
    import importlib

    original = importlib.import_module(module_name).ForwardCommander.offer

    @functools.wraps(original)
    def offer(self, values):
        return original(self, [2 * value for value in values])

    return offer


def test_a_recording_without_periods_is_not_called_equal(swung, capsys, recorded, parts):
    path = str(recorded(parts.pendulum(), "none.run").finish())
    assert main(["sim", "replay", path]) == 1
    assert "holds no control period, so nothing was compared" in capsys.readouterr().err


def test_a_recording_of_another_machine_is_told(swung, capsys, monkeypatch):
    path = swung()
    monkeypatch.setattr("mujoco.__version__", "3.0.0")
    assert main(["sim", "replay", path]) == 0
    printed = capsys.readouterr().err
    assert "was made with mujoco" in printed
    assert "(here 3.0.0)" in printed


def test_a_cut_off_recording_is_told(swung, capsys, tmp_path):
    content, cut = Path(swung()).read_bytes(), tmp_path / "cut.run"
    for size in range(len(content), 0, -1):
        cut.write_bytes(content[:size])
        if not any(isinstance(record, RecordingEnd) for record in RunFile(cut).records()):
            break
    assert main(["sim", "replay", str(cut)]) == 0
    assert "the recording has no end" in capsys.readouterr().out


def test_what_cannot_be_read_is_one_sentence(capsys, tmp_path):
    path = tmp_path / "none.run"
    assert main(["sim", "replay", str(path)]) == 1
    assert capsys.readouterr().err == f"arm sim replay: {path} does not exist\n"
    path.write_text("hello")
    assert main(["sim", "diff", str(path), str(path)]) == 1
    assert "is not a recording of a run" in capsys.readouterr().err


def test_equal_recordings_have_no_difference(swung, capsys):
    assert main(["sim", "diff", swung("a.run"), swung("b.run")]) == 0
    assert capsys.readouterr().out == "30 control periods are equal\n"


def test_the_first_difference_of_two_recordings_is_named(swung, capsys):
    assert main(["sim", "diff", swung("a.run"), swung("b.run", 0.6, periods=35)]) == 1
    printed = capsys.readouterr().out
    assert "control period 10, at 0.110 s, differs:" in printed
    assert "inputs: pos offer instead of pos offer" in printed
    assert "the second recording has 5 more control periods" in printed
