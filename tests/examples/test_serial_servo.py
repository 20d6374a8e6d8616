"""The example's driver, against its fake servos on a pseudo-terminal."""

import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from arm_control import HardwareReturn

TIMEOUT_S = 60.0


@pytest.fixture
def servo(port, servo_info):
    from servo_arm.serial_servo import SerialServo

    return SerialServo(servo_info(port))


@pytest.fixture
def silent_port(tmp_path) -> Iterator[Path]:
    """Return a port behind which nobody answers."""
    from servo_arm.fake_servo import pseudo_terminal

    link = tmp_path / "silent"
    with pseudo_terminal(link):
        yield link


def test_efforts_move_the_joints(servo):
    assert servo.on_configure()
    assert servo.on_activate()
    servo.commands[:] = (0.5, -0.5)
    for _ in range(1000):
        assert servo.write(0.0, 0.01) is HardwareReturn.OK
        assert servo.read(0.0, 0.01) is HardwareReturn.OK
        if servo.get_state("shoulder/position") > 0.01 > -0.01 > servo.get_state("elbow/position"):
            break
    assert servo.get_state("shoulder/velocity") > 0.0 > servo.get_state("elbow/velocity")
    assert servo.on_shutdown()


def test_no_command_is_no_effort(servo):
    assert servo.on_configure()
    assert servo.on_activate()
    assert np.isnan(servo.commands).all()
    assert servo.write(0.0, 0.01) is HardwareReturn.OK
    assert servo.read(0.0, 0.01) is HardwareReturn.OK
    assert servo.states.tolist() == [0.0] * 4
    assert servo.on_shutdown()


def test_a_port_that_is_not_there_is_named(tmp_path, servo_info, caplog):
    from servo_arm.serial_servo import SerialServo

    missing = SerialServo(servo_info(tmp_path / "nothing"))

    assert not missing.on_configure()
    assert f"cannot open {tmp_path / 'nothing'}: No such file or directory" in caplog.text


def test_silence_is_an_error(silent_port, servo_info, caplog):
    from servo_arm.serial_servo import SerialServo

    silent = SerialServo(servo_info(silent_port, timeout_s=0.01))

    assert not silent.on_configure()
    assert f"{silent_port} did not answer 'get' within 0.01 s" in caplog.text
    assert silent.on_cleanup()


def test_a_servo_that_goes_away_is_an_error_and_can_come_back(tmp_path, servo_info, caplog):
    from servo_arm.fake_servo import pseudo_terminal, serve
    from servo_arm.serial_servo import SerialServo

    link = tmp_path / "port"
    servo = SerialServo(servo_info(link, timeout_s=1.0))
    for _ in range(2):
        with pseudo_terminal(link) as near:
            answering = threading.Thread(target=_serve, args=(serve, near), daemon=True)
            answering.start()
            assert servo.on_configure()
            assert servo.read(0.0, 0.01) is HardwareReturn.OK
        assert servo.read(0.0, 0.01) is HardwareReturn.ERROR
        assert servo.on_cleanup()
        # It may not answer on the next terminal, which gets the same number.
        answering.join(TIMEOUT_S)
        assert not answering.is_alive()
    assert str(link) in caplog.text


def test_nonsense_is_an_error(tmp_path, servo_info, caplog):
    from servo_arm.fake_servo import pseudo_terminal
    from servo_arm.serial_servo import SerialServo

    link = tmp_path / "port"
    with pseudo_terminal(link) as near:

        def babble() -> None:
            os.read(near, 100)
            os.write(near, b"1.0 two\n")

        threading.Thread(target=babble, daemon=True).start()
        assert not SerialServo(servo_info(link)).on_configure()
    assert "4 numbers expected, '1.0 two' received" in caplog.text


def test_the_fake_lets_go_without_commands():
    from servo_arm.fake_servo import WATCHDOG_S, Motors

    motors = Motors(1, 0.0)
    assert motors.answer("on", 0.0) == "ok"
    assert motors.answer("set 1.0", 0.0) == "ok"
    driven = float(motors.answer("get", WATCHDOG_S).split()[1])
    later = float(motors.answer("get", WATCHDOG_S + 1.0).split()[1])
    assert driven > 1.0
    assert later < 0.1 * driven


@pytest.mark.parametrize("request_line", ["", "jump", "set 1.0 2.0", "set x"])
def test_the_fake_answers_what_it_does_not_understand(request_line):
    from servo_arm.fake_servo import Motors

    assert Motors(1, 0.0).answer(request_line, 0.0).startswith("error: ")


def _serve(serve: Callable[[int, int], None], near: int) -> None:
    try:
        serve(near, 2)
    except OSError:
        return
