"""The plugin of Feetech's servos against emulated ones: faults, limits, errors, recovery."""

import errno
import json
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import serial

from arm_control import HardwareReturn
from arm_control.errors import HardwareInfoError
from arm_drivers.feetech.hardware import FeetechHardware
from arm_sim.bench.feetech_servos import EmulatedServo, FeetechServos
from arm_sim.bench.mycobot_arm import EmulatedMyCobot
from arm_sim.bench.serial_device import EmulatedPort, ReplyFaults

WAIT_S = 60.0
STEP = 2 * np.pi / 4096
POSITIONS = [0, 3, 6]


@pytest.fixture
def hardware(feetech_info) -> Iterator[FeetechHardware]:
    made = FeetechHardware(feetech_info())
    yield made
    made.on_cleanup()


@pytest.fixture
def active(hardware, servos) -> FeetechHardware:
    servos.servos[2].position = 1000.0
    assert hardware.on_configure()
    assert hardware.on_activate()
    return hardware


def test_it_holds_the_measured_positions_when_it_is_activated(active, servos):
    assert active.states[POSITIONS] == pytest.approx([0.0, (1000 - 2048) * STEP, 0.0])
    assert [servo.load(42) for servo in servos.servos.values()] == [2048, 1000, 2048]
    assert [servo.memory[40] for servo in servos.servos.values()] == [1, 1, 1]


def test_a_servo_that_misses_its_first_goal_is_not_powered(hardware, servos, monkeypatch, caplog):
    servos.servos[2].position = 1000.0
    monkeypatch.setattr(EmulatedServo, "write", lambda servo, address, data: None)
    assert hardware.on_configure()
    assert not hardware.on_activate()
    assert "servo 2 was told goal position 1000, but it holds 2048" in caplog.text
    assert not any(servo.memory[40] for servo in servos.servos.values())


def test_it_follows_commands_and_computes_the_joint_that_mimics(active, run_until):
    active.commands[0] = 0.5
    assert run_until(active, lambda: active.states[0] > 0.499) is HardwareReturn.OK
    assert active.states[9] == pytest.approx(2 * active.states[0] + 0.1)


def test_it_moves_no_faster_than_it_may(feetech_info, servos, run_until):
    hardware = FeetechHardware(feetech_info(max_velocity="0.01"))
    started = time.monotonic()
    assert hardware.on_configure()
    assert hardware.on_activate()
    hardware.commands[0] = 3.0
    run_until(hardware, lambda: servos.servos[1].load(42) > 2048)
    assert (servos.servos[1].load(42) - 2049) * STEP <= 0.01 * (time.monotonic() - started)
    hardware.on_cleanup()


def test_a_goal_outside_a_servo_s_limits_stops_there_and_is_told(
    hardware, servos, caplog, run_until
):
    servos.servos[1].store(9, 1500)
    servos.servos[1].store(11, 2500)
    assert hardware.on_configure()
    assert hardware.on_activate()
    hardware.commands[0] = 2.0
    run_until(hardware, lambda: servos.servos[1].position == 2500)
    assert "servo 1 (j0) is told 2.000 rad; the arm's own limits are -0.841 to 0.693" in caplog.text


def test_an_emergency_stop_holds_whatever_is_commanded(active, servos, run_until):
    active.set_emergency_stop(True)
    active.commands[0] = 1.0
    thread = active.thread
    assert thread is not None
    after = thread.exchanges + 20
    run_until(active, lambda: thread.exchanges > after)
    assert servos.servos[1].load(42) == 2048
    active.set_emergency_stop(False)
    assert active.commands[0] == pytest.approx(0.0)


@pytest.mark.parametrize("kind", ["lost", "damaged", "late", "doubled", "short", "noise"])
def test_faulty_replies_cost_nothing_but_their_values(kind, feetech_info, servos, port, run_until):
    servos.servos[2].position = 1000.0
    hardware = FeetechHardware(feetech_info(reply_timeout="0.1", max_missed="100"))
    assert hardware.on_configure()
    assert hardware.on_activate()
    thread = hardware.thread
    assert thread is not None
    port.faults = ReplyFaults(0.1, (kind,), late_s=0.15)
    after = thread.exchanges + 60

    def seen() -> bool:
        assert hardware.states[POSITIONS] == pytest.approx([0.0, (1000 - 2048) * STEP, 0.0])
        return thread.exchanges > after

    assert run_until(hardware, seen) is HardwareReturn.OK
    assert port.faults.counts[kind] > 0
    hardware.on_cleanup()


def test_a_servo_that_goes_silent_is_named_and_counted_and_the_others_hold(
    active, servos, caplog, run_until
):
    servos.servos[2].silent = True
    assert run_until(active) is HardwareReturn.ERROR
    assert "servo 2 (j1) did not answer" in caplog.text
    values = active.health().values
    assert int(values["exchanges"]) >= int(values["j1.missed_replies"]) >= 5
    assert values.keys() == {"exchanges", *(f"j{n}.missed_replies" for n in range(3))}
    active.on_cleanup()
    assert [servos.servos[number].memory[40] for number in (1, 3)] == [1, 1]


def test_a_port_that_is_pulled_out_is_told_and_the_arm_is_taken_up_again(
    active, port, caplog, run_until
):
    port.unplug()
    assert run_until(active) is HardwareReturn.ERROR
    assert f"port {port.path} has gone" in caplog.text
    active.on_cleanup()
    assert not active.on_configure()
    assert f"no port {port.path}" in caplog.text
    port.plug()
    assert active.on_configure()
    assert active.on_activate()


def test_an_overload_ends_it_and_is_over_when_it_is_activated_again(
    active, servos, caplog, run_until
):
    servos.servos[1].overloaded = True
    assert run_until(active) is HardwareReturn.ERROR
    assert "servo 1 (j0) reports an alarm: it is overloaded and lets go" in caplog.text
    active.on_cleanup()
    assert active.health().problem in caplog.text
    assert active.on_configure()
    assert active.on_activate()
    assert not servos.servos[1].overloaded
    assert run_until(active, lambda: not active.health().problem) is HardwareReturn.OK


@pytest.mark.parametrize(
    ("alarm", "voltage", "sentence"),
    [
        (2, 74, "servo 2 (j1) reports an alarm: its encoder has failed"),
        (4, 74, "servo 2 (j1) reports an alarm: it is too hot"),
        (8, 74, "servo 2 (j1) reports an alarm: its current is too high"),
        (0, 35, "servo 2 (j1) has 3.5 V; it needs 4 to 8 V"),
    ],
)
def test_a_fault_of_a_servo_is_told_until_the_arm_is_fit_again(
    active, servos, alarm, voltage, sentence, run_until
):
    assert active.health().problem == ""
    servos.servos[2].alarms, servos.servos[2].memory[62] = alarm, voltage
    assert run_until(active) is HardwareReturn.ERROR
    active.on_cleanup()
    assert active.health().problem == sentence
    assert not active.on_configure()
    assert active.health().problem == sentence
    servos.servos[2].alarms, servos.servos[2].memory[62] = 0, 74
    assert active.on_configure()
    assert active.health().problem == ""


def test_a_joint_that_cannot_follow_is_told(active, servos, caplog, run_until):
    servos.servos[1].blocked = True
    active.commands[0] = 0.5
    run_until(active, lambda: "is pushed, blocked or too weak" in caplog.text)
    assert "servo 1 (j0) is 0.50 rad from where it is held" in caplog.text


def test_without_commands_it_holds(feetech_info, servos, caplog):
    hardware = FeetechHardware(feetech_info(watchdog="0.05", max_velocity="0.1"))
    assert hardware.on_configure()
    assert hardware.on_activate()
    hardware.commands[0] = 3.0
    hardware.write(0.0, 0.01)
    deadline = time.monotonic() + WAIT_S
    while "the arm holds where it is" not in caplog.text and time.monotonic() < deadline:
        time.sleep(0.01)
    assert "no command for 0.05 s: the arm holds where it is" in caplog.text
    hardware.on_cleanup()


@pytest.mark.parametrize(("at_end", "torque"), [("hold", 1), ("release", 0)])
def test_at_the_end_it_holds_or_lets_go(at_end, torque, feetech_info, servos):
    hardware = FeetechHardware(feetech_info(at_end=at_end))
    assert hardware.on_configure()
    assert hardware.on_activate()
    assert hardware.on_shutdown()
    assert {servo.memory[40] for servo in servos.servos.values()} == {torque}


def _silent(servos: FeetechServos) -> None:
    servos.servos[3].silent = True


def _twins(servos: FeetechServos) -> None:
    servos.servos[2].twin = True


def _low_voltage(servos: FeetechServos) -> None:
    servos.servos[1].memory[62] = 39


def _other_model(servos: FeetechServos) -> None:
    servos.servos[1].store(3, 1284)


def _wheel(servos: FeetechServos) -> None:
    servos.servos[1].memory[33] = 1


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (_silent, "servo 3 (j2) does not answer; the other servos do"),
        (_twins, "servo 2 replies, but never soundly: two servos have this id"),
        (_low_voltage, "servo 1 (j0) has 3.9 V; it needs 4 to 8 V"),
        (_other_model, "servo 1 (j0) is of model 1284; the driver knows the STS3215, 777"),
        (_wheel, "servo 1 (j0) is in mode 1; the driver needs position mode, 0"),
    ],
)
def test_an_arm_that_is_not_fit_is_refused_in_one_sentence(
    spoil, sentence, hardware, servos, caplog
):
    spoil(servos)
    assert not hardware.on_configure()
    assert sentence in caplog.text
    assert not any(servo.memory[40] for servo in servos.servos.values())


def calibration(folder: Path, **changes: int) -> str:
    joint = {"drive_mode": 0, "homing_offset": 0, "range_min": 500, "range_max": 3500}
    content = {f"j{number}": {"id": number + 1, **joint, **changes} for number in range(3)}
    file = folder / "calibration.json"
    file.write_text(json.dumps(content))
    return str(file)


def test_lerobot_s_calibration_gives_middle_direction_and_range(tmp_path, feetech_info, servos):
    servos.servos[1].position = 2147.0
    hardware = FeetechHardware(feetech_info(calibration=calibration(tmp_path, drive_mode=1)))
    assert hardware.on_configure()
    assert hardware.states[0] == pytest.approx(-100 * STEP)
    hardware.on_cleanup()


def test_a_joint_that_rests_outside_its_calibrated_range_does_not_jump_into_it(
    tmp_path, feetech_info, servos, run_until
):
    servos.servos[1].position = 3550.0
    file = calibration(tmp_path)
    hardware = FeetechHardware(feetech_info(calibration=file, max_velocity="0.5"))
    assert hardware.on_configure()
    assert hardware.on_activate()
    assert servos.servos[1].load(42) == 3550
    assert run_until(hardware, lambda: servos.servos[1].position == 3500) is HardwareReturn.OK
    hardware.on_cleanup()


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"homing_offset": 12}, "the calibration is of another arm: servo 1 (j0) holds the"),
        ({"range_min": 2300}, "servo 1 (j0) stands at 2048, outside its range, 2300 to 3500"),
        ({"range_max": 100}, "the range of joint 'j0' is empty, 500 to 100"),
    ],
)
def test_the_calibration_of_another_arm_is_refused(
    changes, sentence, tmp_path, feetech_info, caplog
):
    hardware = FeetechHardware(feetech_info(calibration=calibration(tmp_path, **changes)))
    assert not hardware.on_configure()
    assert sentence in caplog.text


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"buad": "115200"}, "no parameter 'buad'; 'arm_drivers/Feetech' has port, reply_timeout"),
        ({"baud": "fast"}, "baud must be a whole number of at least 1, not 'fast'"),
        ({"at_end": "fall"}, "at_end must be one of hold, release"),
    ],
)
def test_a_wrong_parameter_is_told(parameters, sentence, feetech_info):
    with pytest.raises(HardwareInfoError) as caught:
        FeetechHardware(feetech_info(**parameters))
    assert sentence in str(caught.value)


def test_a_file_that_is_not_a_port_is_told(tmp_path, feetech_info, caplog):
    file = tmp_path / "file"
    file.touch()
    assert not FeetechHardware(feetech_info(port=str(file))).on_configure()
    assert f"{file} is not a serial port" in caplog.text


def test_the_wrong_baud_rate_is_told(feetech_info, caplog):
    slow = feetech_info(baud="115200", reply_timeout="0.02")
    assert not FeetechHardware(slow).on_configure()
    assert "at 115200 baud: check the power of the servos, the port and the baud" in caplog.text


def test_another_device_is_told(tmp_path, make_info, caplog):
    with EmulatedPort(EmulatedMyCobot(1_000_000), tmp_path / "cobot") as port:
        info = make_info("arm_drivers/Feetech", 3, port=str(port.path))
        assert not FeetechHardware(info).on_configure()
    assert f"no Feetech servo answers on {port.path}" in caplog.text


@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        (errno.EACCES, "this user may not open port /dev/arm: sudo usermod -aG dialout $USER"),
        (errno.EIO, "/dev/arm is not a serial port"),
    ],
)
def test_a_port_that_may_not_be_opened_is_told(code, sentence, make_info, monkeypatch, caplog):
    def refuse(*_: object, **__: object) -> None:
        raise serial.SerialException(code, "could not open port")

    monkeypatch.setattr(serial, "Serial", refuse)
    assert not FeetechHardware(make_info("arm_drivers/Feetech", 3, port="/dev/arm")).on_configure()
    assert sentence in caplog.text


def test_a_port_in_use_is_told(active, feetech_info, caplog):
    assert not FeetechHardware(feetech_info()).on_configure()
    assert "is in use by another program" in caplog.text


def test_a_command_of_velocity_is_refused(hardware):
    assert hardware.prepare_command_mode_switch(["j0/position"], [])
    assert not hardware.prepare_command_mode_switch(["j0/velocity"], [])
