"""Emulated Feetech STS3215 servos on one bus.

`python -m arm_sim.bench.feetech_servos --port /tmp/servos` runs them for `hardware:=feetech
port:=/tmp/servos`. The frames are written here once more, so that the driver is not its own judge.
"""

import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from arm_sim.bench.serial_device import TimedBytes, run_emulator

EVERY = 254
MEMORY = 86
EPROM_END = 40
MAX_SPEED = 3000
"""Steps per second of a servo without a speed of its own."""
OVERLOAD_BIT, VOLTAGE_BIT = 32, 1
VOLTAGE_ADDRESS, LOCK, TORQUE, MODEL = 62, 55, 40, 777


@dataclass(slots=True)
class EmulatedServo:
    """One servo.

    Attributes:
        position: in steps; set it to move the joint by hand.
        overloaded: it lets go until its torque is switched.
        alarms: error bits of its replies beside those of overload and voltage: 2 for its encoder,
            4 for its temperature, 8 for its current.
        blocked: whether something keeps the joint where it is.
        twin: whether another servo has the same id, so that their replies collide.
        silent: whether it is not connected.
        memory: its registers.
    """

    position: float = 2048.0
    speed: float = 0.0
    overloaded: bool = False
    alarms: int = 0
    blocked: bool = False
    twin: bool = False
    silent: bool = False
    memory: bytearray = field(default_factory=lambda: bytearray(MEMORY))
    _saved: bytes = b""

    def __post_init__(self) -> None:
        for address, value in ((3, MODEL), (9, 0), (11, 4095), (16, 1000), (48, 1000)):
            self.store(address, value)
        self.memory[6:9] = bytes((0, 0, 1))
        self.memory[13:16] = bytes((70, 80, 40))
        self.memory[LOCK] = 1
        self.memory[VOLTAGE_ADDRESS : VOLTAGE_ADDRESS + 2] = bytes((74, 30))
        self.store(42, round(self.position))
        self._saved = bytes(self.memory)

    def store(self, address: int, value: int) -> None:
        """Set a register of two bytes; negative values get the sign bit 15."""
        raw = abs(value) | (0x8000 if value < 0 else 0)
        self.memory[address : address + 2] = raw.to_bytes(2, "little")

    def load(self, address: int) -> int:
        """Return a register of two bytes without a sign."""
        return int.from_bytes(self.memory[address : address + 2], "little")

    def power_cycle(self) -> None:
        """Power off and on: what is not saved is lost, and torque is off."""
        self.memory[:] = self._saved
        self.overloaded = False

    def write(self, address: int, data: bytes) -> None:
        """Take new values; those of the EPROM last if the lock is open."""
        self.memory[address : address + len(data)] = data[: max(0, MEMORY - address)]
        if address < EPROM_END and not self.memory[LOCK]:
            self._saved = bytes(self.memory[:EPROM_END]) + self._saved[EPROM_END:]
        if address <= TORQUE < address + len(data) and not self.memory[TORQUE]:
            self.overloaded = False

    def advance(self, period_s: float) -> None:
        """Move towards the goal, and note position and speed."""
        lowest, highest = self.load(9), self.load(11)
        goal = min(max(self.load(42) & 0x7FFF, lowest), highest if highest else 4095)
        reach = (self.load(46) & 0x7FFF or MAX_SPEED) * period_s
        holds = self.memory[TORQUE] and not self.overloaded and not self.blocked
        step = min(max(goal - self.position, -reach), reach) if holds else 0.0
        self.position += step
        self.speed = step / period_s if period_s else self.speed
        self.store(56, round(self.position))
        self.store(58, round(self.speed))

    @property
    def error(self) -> int:
        """The error bits of its replies."""
        volts = self.memory[VOLTAGE_ADDRESS]
        low = VOLTAGE_BIT if not self.memory[15] <= volts <= self.memory[14] else 0
        return low | self.alarms | (OVERLOAD_BIT if self.overloaded else 0)


class FeetechServos:
    """Servos on a bus: they answer as real ones do, and are silent where those are.

    Attributes:
        baud: of the bus.
        servos: by id.
    """

    def __init__(self, ids: Iterable[int] = range(1, 7), baud: int = 1_000_000) -> None:
        self.baud = baud
        self.servos = {number: EmulatedServo() for number in ids}
        for number, servo in self.servos.items():
            servo.memory[5] = number
            servo.power_cycle()
            servo.memory[5] = number
        self._rest = b""
        self._last_s: float | None = None

    def receive(self, data: bytes, now_s: float) -> list[TimedBytes]:
        """Answer requests; see `SerialDevice`."""
        period_s = now_s - self._last_s if self._last_s is not None else 0.0
        self._last_s = now_s
        for servo in self.servos.values():
            servo.advance(period_s)
        self._rest += data
        return [reply for body in self._requests() for reply in self._answer(body)]

    def shorten(self, reply: bytes) -> bytes:
        """Return a well-formed reply that lacks the last byte; see `SerialDevice`."""
        return _framed(reply[2:3] + bytes((reply[3] - 1,)) + reply[4:-2]) if reply[3] > 2 else reply

    def _requests(self) -> Iterator[bytes]:
        """Yield what stands between header and checksum of each sound request."""
        while (start := self._rest.find(b"\xff\xff")) >= 0:
            frame = self._rest[start:]
            if len(frame) < 4 or len(frame) < frame[3] + 4:
                self._rest = frame
                return
            size = frame[3] + 4
            sound = frame[3] >= 2 and _framed(frame[2 : size - 1]) == frame[:size]
            self._rest = frame[size if sound else 1 :]
            if sound:
                yield frame[2 : size - 1]

    def _answer(self, body: bytes) -> Iterator[TimedBytes]:
        number, instruction, parameters = body[0], body[2], body[3:]
        servo = self.servos.get(number)
        if instruction == 0x82 and number == EVERY:
            for each in parameters[2:]:
                if each in self.servos:
                    yield from self._read(each, parameters[0], parameters[1])
        elif instruction == 0x83 and number == EVERY:
            address, count = parameters[:2]
            for at in range(2, len(parameters), count + 1):
                if parameters[at] in self.servos:
                    self.servos[parameters[at]].write(address, parameters[at + 1 : at + 1 + count])
        elif servo is not None and instruction == 2:
            yield from self._read(number, parameters[0], parameters[1])
        elif servo is not None and instruction in (1, 3):
            if instruction == 3:
                servo.write(parameters[0], parameters[1:])
            if servo.memory[8] or instruction == 1:
                yield from self._reply(number, b"")

    def _read(self, number: int, address: int, count: int) -> Iterator[TimedBytes]:
        memory = self.servos[number].memory
        yield from self._reply(number, bytes(memory[address : address + count].ljust(count, b"\0")))

    def _reply(self, number: int, data: bytes) -> Iterator[TimedBytes]:
        servo = self.servos[number]
        if servo.silent:
            return
        frame = _framed(bytes((number, len(data) + 2, servo.error)) + data)
        if servo.twin:
            # Both drive the line at once; a 0 wins over a 1.
            other = _framed(frame[2:-1][:-1] + bytes((frame[-2] ^ 0x55,)))
            frame = bytes(mine & theirs for mine, theirs in zip(frame, other, strict=True))
        yield TimedBytes(frame, 2e-6 * servo.memory[7])


def _framed(body: bytes) -> bytes:
    return b"\xff\xff" + body + bytes((~sum(body) & 0xFF,))


def main(argv: Sequence[str] | None = None) -> int:
    """Run six servos until a signal."""
    return run_emulator("six Feetech servos", FeetechServos(), "/tmp/servos", argv)


if __name__ == "__main__":
    sys.exit(main())
