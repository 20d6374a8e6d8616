"""`arm calibrate` on emulated servos, which a scripted hand moves."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from arm_cli.main import main
from arm_drivers.calibration import JointCalibration, read_calibration
from arm_sim.bench.feetech_servos import FeetechServos
from arm_sim.bench.serial_device import EmulatedPort


@pytest.fixture
def servos() -> FeetechServos:
    return FeetechServos((1, 6))


@pytest.fixture
def words(servos, tmp_path) -> Iterator[list[str]]:
    with EmulatedPort(servos, tmp_path / "port") as port:
        yield ["calibrate", str(tmp_path / "arm.json"), "pan", "lift=6", "--port", str(port.path)]


def test_it_writes_where_the_joints_were_moved(servos, words, monkeypatch, capfd):
    places = iter((None, (2000, 2100), None, (1500, 3000), (2600, 1000), None))

    def is_entered(timeout_s: float) -> bool:
        place = next(places)
        for servo, position in zip(servos.servos.values(), place or (), strict=False):
            servo.position = position
        return place is None

    monkeypatch.setattr("arm_cli.calibrate._entered", is_entered)
    monkeypatch.setattr("arm_cli.calibrate.REPLY_TIMEOUT_S", 5.0)
    for servo in servos.servos.values():
        servo.memory[40] = 1
    assert main(words) == 0
    assert "pan: 1500 to 2600\nlift: 1000 to 3000\nwrote " in capfd.readouterr().out
    assert read_calibration(Path(words[1])) == {
        "pan": JointCalibration(1, 0, 0, 1500, 2600, 2000),
        "lift": JointCalibration(6, 0, 0, 1000, 3000, 2100),
    }
    assert not any(servo.memory[40] for servo in servos.servos.values())


def test_it_needs_someone_at_the_keyboard(words, monkeypatch, capfd):
    with open(os.devnull) as nobody:
        monkeypatch.setattr(sys, "stdin", nobody)
        assert main(words) == 2
    assert "needs someone at the keyboard: run it in a terminal" in capfd.readouterr().err
    assert not Path(words[1]).exists()
