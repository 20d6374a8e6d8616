"""Looks for the servos on a bus, at any of its baud rates; nothing moves and nothing is changed."""

from dataclasses import dataclass

from arm_drivers.feetech.bus import FeetechBus
from arm_drivers.feetech.registers import (
    MAX_POSITION,
    MAX_VOLTAGE,
    MIN_POSITION,
    MIN_VOLTAGE,
    MODEL_NUMBER,
    MOTION_COUNT,
    OFFSET,
    POSITION,
    SETUP_COUNT,
    VOLTAGE,
)
from arm_drivers.serial_line import SerialLine

BAUDS = (1_000_000, 500_000, 250_000, 128_000, 115_200)
"""The rates of a servo's register, the factory's first."""
IDS = range(1, 33)
"""Where servos are looked for."""


@dataclass(frozen=True, slots=True)
class FoundServo:
    """A servo that answers.

    Attributes:
        id: on the bus.
        model: the number of its model.
        volts: its supply, in V; NaN if it did not say.
        volts_range: lowest and highest supply that it accepts, in V.
        limits: lowest and highest position, in steps.
        offset: what its register of the offset holds, in steps.
        position: in steps; None if it did not say.
    """

    id: int
    model: int
    volts: float
    volts_range: tuple[float, float]
    limits: tuple[int, int]
    offset: int
    position: int | None


def find_servos(bus: FeetechBus) -> tuple[FoundServo, ...]:
    """Return the servos that answer, by their id.

    Raises:
        PortError: the port has gone.
    """
    setups = bus.read_all(IDS, 0, SETUP_COUNT)
    # A servo that is silent costs the whole time, so only those that answer are asked again.
    motions = bus.read_all(tuple(setups), POSITION.address, MOTION_COUNT) if setups else {}
    found: list[FoundServo] = []
    for servo, setup in setups.items():
        data, motion = setup.data, motions.get(servo)
        volts = VOLTAGE.decode(motion.data, POSITION.address) / 10 if motion else float("nan")
        found.append(
            FoundServo(
                servo,
                MODEL_NUMBER.decode(data),
                volts,
                (MIN_VOLTAGE.decode(data) / 10, MAX_VOLTAGE.decode(data) / 10),
                (MIN_POSITION.decode(data), MAX_POSITION.decode(data)),
                OFFSET.decode(data),
                POSITION.decode(motion.data, POSITION.address) if motion else None,
            )
        )
    return tuple(found)


def find_baud(port: str, reply_timeout_s: float) -> tuple[int, tuple[FoundServo, ...]]:
    """Return the first baud rate at which servos answer, and the servos; the first rate and none.

    Raises:
        PortError: the port cannot be opened.
    """
    for baud in BAUDS:
        line = SerialLine(port, baud)
        try:
            found = find_servos(FeetechBus(line, reply_timeout_s))
        finally:
            line.close()
        if found:
            return baud, found
    return BAUDS[0], ()
