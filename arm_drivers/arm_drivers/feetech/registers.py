"""The registers of an STS3215 that the driver uses. Positions are steps, 4096 a turn."""

from dataclasses import dataclass

MODEL = 777
"""What an STS3215 holds in its register of the model."""
STEPS = 4096
"""Steps in a turn."""
MIDDLE = 2048
"""The position in the middle of the turn."""


@dataclass(frozen=True, slots=True)
class Register:
    """A number in a servo's memory, low byte first.

    Attributes:
        name: for messages.
        address: of its first byte.
        size: 1 or 2 bytes.
        sign: the bit that makes the rest negative; None for a number without a sign.
    """

    name: str
    address: int
    size: int
    sign: int | None = None

    @property
    def largest(self) -> int:
        """The largest magnitude that fits."""
        return (1 << (8 * self.size if self.sign is None else self.sign)) - 1

    def encode(self, value: int) -> bytes:
        """Return its bytes.

        Raises:
            ValueError: the value does not fit.
        """
        if abs(value) > self.largest or (self.sign is None and value < 0):
            raise ValueError(f"register '{self.name}' does not hold {value}")
        magnitude = abs(value) | (1 << self.sign if self.sign is not None and value < 0 else 0)
        return magnitude.to_bytes(self.size, "little")

    def decode(self, block: bytes, start: int = 0) -> int:
        """Return its value from a block of memory that begins at the address `start`."""
        at = self.address - start
        value = int.from_bytes(block[at : at + self.size], "little")
        if self.sign is None:
            return value
        magnitude = value & self.largest
        return -magnitude if value & (1 << self.sign) else magnitude


MODEL_NUMBER = Register("model", 3, 2)
MIN_POSITION = Register("lowest position", 9, 2)
MAX_POSITION = Register("highest position", 11, 2)
MAX_VOLTAGE = Register("highest voltage", 14, 1)
MIN_VOLTAGE = Register("lowest voltage", 15, 1)
OFFSET = Register("offset", 31, 2, sign=11)
MODE = Register("mode", 33, 1)
TORQUE = Register("torque", 40, 1)
GOAL = Register("goal position", 42, 2, sign=15)
POSITION = Register("position", 56, 2, sign=15)
SPEED = Register("speed", 58, 2, sign=15)
LOAD = Register("load", 60, 2, sign=10)
VOLTAGE = Register("voltage", 62, 1)

SETUP_COUNT = 34
"""Bytes from address 0 on that hold the settings above."""
MOTION_COUNT = 7
"""Bytes from POSITION on: position, speed, load and voltage."""
