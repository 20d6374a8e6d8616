import pytest

from arm_gazebo.recording.comparison import compare
from arm_gazebo.recording.run_file import RunFile

FORWARD = "position_controllers/JointGroupPositionController"


@pytest.fixture
def swung(recorded, parts):
    """Return a function that records a pendulum that is given a command; returns the file."""

    def swing(name: str, command: float, periods: int = 30, mass: str = "", **more) -> RunFile:
        urdf = parts.pendulum().replace('mass value="1.0"', f'mass value="{mass}"') if mass else ""
        run = recorded(urdf or parts.pendulum(), name, **more)
        controller = run.start_controller("pos", FORWARD, joints=("j",))
        run.run(10)
        controller.offer([command])
        run.run(periods - 10)
        return RunFile(run.finish())

    return swing


def test_two_recordings_of_one_run_are_equal(swung):
    result = compare(swung("a.run", 0.5), swung("b.run", 0.5))
    assert result.is_equal
    assert result.periods == 30
    assert result.difference is None
    assert result.settings == ()


def test_another_command_is_named_with_its_period(swung):
    result = compare(swung("a.run", 0.5), swung("b.run", 0.6))
    assert not result.is_equal
    assert result.periods == 10
    assert result.difference.period == 10
    assert result.difference.time_s == pytest.approx(0.11)
    assert result.difference.lines[0] == "inputs: pos offer instead of pos offer"
    assert (
        "command j/position of /controller_manager: 0.6 instead of 0.5"
        in (result.difference.lines[1])
    )


def test_a_longer_recording_is_not_equal(swung):
    result = compare(swung("a.run", 0.5), swung("b.run", 0.5, periods=35))
    assert result.difference is None
    assert result.longer == 5
    assert not result.is_equal
    assert compare(swung("c.run", 0.5, periods=35), swung("d.run", 0.5)).longer == -5


def test_other_settings_and_models_are_named(swung):
    result = compare(swung("a.run", 0.5), swung("b.run", 0.5, mass="1.5", seed=3))
    assert "the models differ" in result.settings
    assert "seed 3 instead of 0" in result.settings
    assert "robot_description of /controller_manager differs" in result.settings
    assert not result.is_equal
