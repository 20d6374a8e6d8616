"""The doctor's checks of a real arm on a serial port; nothing moves."""

from collections.abc import Iterator
from pathlib import Path

from arm_cli.doctor.diagnosis import Diagnosis
from arm_drivers.errors import DriverError, PortError
from arm_drivers.feetech.registers import MODEL
from arm_drivers.feetech.survey import FoundServo, find_baud
from arm_drivers.mycobot.hardware import MyCobotArm
from arm_drivers.serial_line import SerialLine

PORT, DEVICE, VOLTAGE, LATENCY = "port", "device", "voltage", "adapter"
REPLY_TIMEOUT_S = 0.05
MYCOBOT_BAUDS = (115_200, 1_000_000)
SLOW_MS = 2
JOINT_NAMES = tuple(f"joint {number}" for number in range(1, 7))


def examine_port(port: str, reply_timeout_s: float = REPLY_TIMEOUT_S) -> Iterator[Diagnosis]:
    """Yield the findings about a port and the arm behind it."""
    try:
        SerialLine(port, MYCOBOT_BAUDS[0]).close()
    except PortError as error:
        yield Diagnosis.error(PORT, str(error), "plug the arm in, or name its port")
        return
    yield Diagnosis.ok(PORT, f"{port} can be opened")
    yield from _check_adapter(port)
    try:
        yield from _check_device(port, reply_timeout_s)
    except DriverError as error:
        yield Diagnosis.error(DEVICE, str(error), "check the cable, then run arm doctor again")


def _check_adapter(port: str) -> Iterator[Diagnosis]:
    """Look for an adapter that keeps bytes back, as FTDI's do for 16 ms."""
    timer = Path("/sys/bus/usb-serial/devices") / Path(port).resolve().name / "latency_timer"
    try:
        delay_ms = int(timer.read_text())
    except (OSError, ValueError):
        return
    if delay_ms > SLOW_MS:
        yield Diagnosis.warning(
            LATENCY, f"{port} keeps bytes back for {delay_ms} ms", f"echo 1 | sudo tee {timer}"
        )


def _check_device(port: str, reply_timeout_s: float) -> Iterator[Diagnosis]:
    baud, servos = find_baud(port, reply_timeout_s)
    if servos:
        rate = "" if baud == 1_000_000 else f"; start with hardware_args:='baud:={baud}'"
        ids = ", ".join(str(servo.id) for servo in servos)
        yield Diagnosis.ok(
            DEVICE, f"Feetech servos {ids} answer at {baud} baud: hardware:=feetech{rate}"
        )
        yield from _check_servos(servos)
        return
    for baud in MYCOBOT_BAUDS:
        line = SerialLine(port, baud)
        try:
            MyCobotArm(line, JOINT_NAMES, None, reply_timeout_s, 1).start()
        except DriverError:
            continue
        finally:
            line.close()
        rate = "" if baud == MYCOBOT_BAUDS[0] else f", with hardware_args:='baud:={baud}'"
        yield Diagnosis.ok(DEVICE, f"a myCobot answers at {baud} baud: hardware:=mycobot_280{rate}")
        return
    yield Diagnosis.error(
        DEVICE,
        f"neither Feetech servos nor a myCobot answer on {port} at any of their baud rates",
        "check the power of the arm and its cable, and that it is this port",
    )


def _check_servos(servos: tuple[FoundServo, ...]) -> Iterator[Diagnosis]:
    for servo in servos:
        if servo.model != MODEL:
            yield Diagnosis.error(
                DEVICE,
                f"servo {servo.id} is of model {servo.model}",
                f"the driver knows the STS3215, model {MODEL}",
            )
    low = [s for s in servos if not s.volts_range[0] <= s.volts <= s.volts_range[1]]
    for servo in low:
        least, most = servo.volts_range
        yield Diagnosis.error(
            VOLTAGE,
            f"servo {servo.id} has {servo.volts:g} V; it needs {least:g} to {most:g} V",
            "check the power supply and its plug",
        )
    if not low:
        volts = [servo.volts for servo in servos]
        yield Diagnosis.ok(VOLTAGE, f"{min(volts):g} to {max(volts):g} V")
