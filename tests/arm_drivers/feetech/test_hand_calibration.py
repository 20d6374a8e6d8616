"""The calibration by hand, and its file."""

import pytest

from arm_drivers.calibration import JointCalibration, read_calibration, write_calibration
from arm_drivers.errors import CalibrationError
from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.feetech.hand_calibration import HandCalibration
from arm_drivers.serial_line import SerialLine


@pytest.fixture
def hand(port):
    line = SerialLine(str(port.path), 1_000_000)
    yield HandCalibration(FeetechBus(line, 0.2), {"pan": 1, "lift": 3})
    line.close()


def move(hand, servos, *positions):
    for pan, lift in positions:
        servos.servos[1].position, servos.servos[3].position = pan, lift
        hand.take_positions()


def test_it_finds_middle_and_ends_with_the_power_off(hand, servos, tmp_path):
    servos.servos[1].memory[40] = 1
    hand.release()
    assert servos.servos[1].memory[40] == 0
    servos.servos[1].position = 2000.0
    hand.take_middle()
    move(hand, servos, (1500, 2048), (2600, 1000), (2000, 3000))
    found = hand.result()
    assert found == {
        "pan": JointCalibration(1, 0, 0, 1500, 2600, 2000),
        "lift": JointCalibration(3, 0, 0, 1000, 3000, 2048),
    }
    write_calibration(tmp_path / "file", found)
    assert read_calibration(tmp_path / "file") == found


def test_a_joint_that_was_not_moved_is_told(hand, servos):
    hand.take_middle()
    move(hand, servos, (1500, 2048), (2600, 2060))
    with pytest.raises(CalibrationError, match="joint lift was not moved to both of its ends"):
        hand.result()


def test_a_joint_that_goes_past_the_end_of_the_turn_is_told(hand, servos):
    servos.servos[1].position = 3900.0
    hand.take_middle()
    with pytest.raises(CalibrationError, match="'pan' goes past the end of its servo's turn"):
        move(hand, servos, (50, 2048))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("no", "is not JSON"),
        ("[]", "has no joints"),
        ('{"a": {"id": 1}}', "joint 'a' needs whole numbers drive_mode, homing_offset"),
    ],
)
def test_a_file_that_is_not_a_calibration_is_told(text, sentence, tmp_path):
    file = tmp_path / "calibration.json"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=sentence):
        read_calibration(file)
