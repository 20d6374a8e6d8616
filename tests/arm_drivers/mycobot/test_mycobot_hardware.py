"""The plugin of the myCobot 280 against an emulated one."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from arm_control import HardwareReturn
from arm_control.errors import HardwareInfoError
from arm_drivers.mycobot.hardware import MyCobotHardware
from arm_sim.bench.mycobot_arm import EmulatedMyCobot
from arm_sim.bench.serial_device import EmulatedPort, ReplyFaults


@pytest.fixture
def cobot() -> EmulatedMyCobot:
    arm = EmulatedMyCobot(baud=1_000_000)
    arm.angles[1] = 30.0
    return arm


@pytest.fixture
def cobot_port(tmp_path, cobot) -> Iterator[EmulatedPort]:
    with EmulatedPort(cobot, tmp_path / "port") as plugged:
        yield plugged


@pytest.fixture
def hardware(cobot_port, make_info) -> Iterator[MyCobotHardware]:
    parameters = {"port": str(cobot_port.path), "reply_timeout": "0.1", "max_missed": "20"}
    made = MyCobotHardware(make_info("arm_drivers/MyCobot280", 6, baud="1000000", **parameters))
    yield made
    made.on_cleanup()


@pytest.fixture
def active(hardware) -> MyCobotHardware:
    assert hardware.on_configure()
    assert hardware.on_activate()
    return hardware


def test_it_holds_the_measured_angles_when_it_is_activated(active, cobot, run_until):
    assert active.states[3] == pytest.approx(math.radians(30.0))
    run_until(active, lambda: active.thread is not None and active.thread.exchanges > 5)
    assert cobot.angles == pytest.approx([0, 30, 0, 0, 0, 0])
    assert not cobot.queue_mode


def test_it_follows_commands_within_the_arm_s_limits(active, cobot, run_until):
    active.commands[0] = 3.0
    run_until(active, lambda: active.states[0] > math.radians(167.9))
    assert cobot.error == 0


@pytest.mark.parametrize("kind", ["lost", "damaged", "late", "doubled", "short", "noise"])
def test_faulty_replies_cost_nothing_but_their_values(kind, active, cobot_port, run_until):
    thread = active.thread
    assert thread is not None
    # Without a checksum, a small error of a damaged byte passes; a jump does not.
    reach = 1.0 if kind == "damaged" else 1e-4
    cobot_port.faults = ReplyFaults(0.2, (kind,), late_s=0.15)
    after = thread.exchanges + 25

    def seen() -> bool:
        assert abs(active.states[3] - math.radians(30.0)) < reach
        return thread.exchanges > after

    assert run_until(active, seen) is HardwareReturn.OK
    assert cobot_port.faults.counts[kind] > 0


def test_a_collision_ends_it(active, cobot, caplog, run_until):
    cobot.error = 17
    assert run_until(active) is HardwareReturn.ERROR
    assert "the myCobot reports a collision, error 17" in caplog.text


def _another_arm(cobot: EmulatedMyCobot) -> None:
    cobot.angles[2] = 170.0


def _mute(cobot: Any) -> None:
    cobot.receive = lambda data, now_s: []


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (_another_arm, "j2 is read at 170.0 degrees; a myCobot 280 turns from -150 to 150"),
        (_mute, "no myCobot answers on"),
    ],
)
def test_an_arm_that_is_not_fit_is_refused_in_one_sentence(
    spoil, sentence, hardware, cobot, caplog
):
    spoil(cobot)
    assert not hardware.on_configure()
    assert sentence in caplog.text


def test_an_arm_that_does_not_power_on_is_told(hardware, cobot, caplog):
    cobot.powered, cobot.power_fails = False, True
    assert hardware.on_configure()
    assert not hardware.on_activate()
    assert "does not power on: is its emergency stop pressed?" in caplog.text


def test_another_number_of_joints_is_refused(make_info):
    with pytest.raises(HardwareInfoError, match=r"6 joints and perhaps a gripper; .* has 4"):
        MyCobotHardware(make_info("arm_drivers/MyCobot280", 4))


def test_states_that_it_does_not_measure_are_not_made_up(active):
    assert np.isnan(active.states[2])
