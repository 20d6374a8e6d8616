"""Faults as people write them."""

import pytest

from arm_gazebo.errors import FaultError
from arm_gazebo.faults.fault import Fault, FaultKind, read_fault


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("joint_stalled j0", Fault(FaultKind.JOINT_STALLED, "j0")),
        ("sensor_noisy imu 0.1", Fault(FaultKind.SENSOR_NOISY, "imu", 0.1)),
        ("sensor_noisy imu 0.1 7", Fault(FaultKind.SENSOR_NOISY, "imu", 0.1, 7)),
        ("slow_tick 0.02", Fault(FaultKind.SLOW_TICK, "", 0.02)),
    ],
)
def test_a_text_is_a_fault(text, fault):
    assert read_fault(text) == fault
    assert fault.text == text


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "'' is not a fault; the kinds are joint_stalled, sensor_frozen"),
        ("broken j0", "'broken j0' is not a fault"),
        ("joint_stalled", "write joint_stalled JOINT"),
        ("joint_stalled j0 j1", "write joint_stalled JOINT"),
        ("sensor_noisy j0", r"write sensor_noisy CHANNEL DEVIATION \[SEED\]"),
        ("sensor_noisy j0 much", "'sensor_noisy j0 much' needs numbers"),
        ("sensor_noisy j0 0.1 0.5", "needs numbers"),
        ("sensor_noisy j0 -1", "sensor_noisy needs a positive number, not -1"),
        ("sensor_noisy j0 0.1 -1", "the seed must be at least 0"),
        ("slow_tick nan", "slow_tick needs a positive number, not nan"),
    ],
)
def test_another_text_gets_a_sentence(text, sentence):
    with pytest.raises(FaultError, match=sentence):
        read_fault(text)
