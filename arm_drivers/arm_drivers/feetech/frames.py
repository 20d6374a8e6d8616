"""The frames of Feetech's STS bus, as bytes. No input or output.

A frame is FF FF, an id, a length, an instruction or error bits, data, and a checksum. The length
counts what follows it. The checksum is the inverted sum of all from the id on. Numbers of two bytes
have the low byte first.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum, IntFlag

HEADER = b"\xff\xff"
ALL = 254
"""The id of a request to every servo."""
AROUND_DATA = 6
"""Bytes of a reply beside its data: header, id, length, error bits, checksum."""


class Instruction(IntEnum):
    """What a request asks for."""

    READ = 2
    WRITE = 3
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83


class Alarm(IntFlag):
    """The error bits of a reply. Bit 4 only says that the torque is on."""

    VOLTAGE = 1
    ENCODER = 2
    TEMPERATURE = 4
    CURRENT = 8
    OVERLOAD = 32


ALARMS = sum(Alarm)


@dataclass(frozen=True, slots=True)
class Reply:
    """A sound frame from a servo.

    Attributes:
        servo: its id.
        alarm: its alarms.
        data: what it replies.
    """

    servo: int
    alarm: Alarm
    data: bytes


def read_request(servo: int, address: int, count: int) -> bytes:
    """Return the request for `count` bytes from an address on."""
    return _frame(servo, Instruction.READ, bytes((address, count)))


def write_request(servo: int, address: int, data: bytes) -> bytes:
    """Return the request to store bytes from an address on."""
    return _frame(servo, Instruction.WRITE, bytes((address,)) + data)


def sync_read_request(servos: Sequence[int], address: int, count: int) -> bytes:
    """Return one request to several servos; each replies, in this order."""
    return _frame(ALL, Instruction.SYNC_READ, bytes((address, count, *servos)))


def sync_write_request(address: int, data: Mapping[int, bytes]) -> bytes:
    """Return one request that stores bytes of one length in several servos; none replies."""
    count = len(next(iter(data.values())))
    each = b"".join(bytes((servo,)) + values for servo, values in data.items())
    return _frame(ALL, Instruction.SYNC_WRITE, bytes((address, count)) + each)


def take_reply(received: bytes, count: int) -> tuple[Reply | None, bytes]:
    """Return the first sound reply with `count` bytes of data, and what is not consumed yet.

    Frames of any other length, damaged ones, and bytes between frames are skipped.
    """
    start = received.find(HEADER)
    size = count + AROUND_DATA
    while start >= 0:
        frame = received[start : start + size]
        if len(frame) <= 3 or frame[3] == count + 2:
            if len(frame) < size:
                return None, received[start:]
            if frame[2] < ALL and frame[-1] == _checksum(frame[2:-1]):
                return Reply(frame[2], Alarm(frame[4] & ALARMS), frame[5:-1]), received[
                    start + size :
                ]
        start = received.find(HEADER, start + 1)
    return None, received[-1:] if received.endswith(HEADER[:1]) else b""


class ReplyCollector:
    """Takes the replies to one request from a stream of bytes that may hold anything.

    It takes only frames of the ids and the length that were asked for, with a right checksum, in
    the order that was asked for. A frame that comes before its turn answers an earlier request, so
    it is dropped as soon as the order shows it. Of two different frames of one servo, neither is
    taken. The request itself, which an adapter may send back, is no reply.
    """

    def __init__(self, request: bytes, servos: Iterable[int], count: int) -> None:
        """Expect a reply with `count` bytes of data from each of these servos."""
        self._turns = {servo: turn for turn, servo in enumerate(servos)}
        self._count = count
        self._echo, _ = take_reply(request, count)
        self._rest = b""
        self._found: dict[int, Reply] = {}
        self._doubtful: set[int] = set()
        self.heard = False
        """Whether any bytes came."""

    @property
    def is_complete(self) -> bool:
        """Whether each servo has replied."""
        return len(self._found) == len(self._turns)

    def replies(self) -> dict[int, Reply]:
        """Return the replies so far by the id of the servo."""
        return {s: reply for s, reply in self._found.items() if s not in self._doubtful}

    def take(self, received: bytes) -> None:
        """Take the next bytes of the stream."""
        self.heard = self.heard or bool(received)
        self._rest += received
        reply, self._rest = take_reply(self._rest, self._count)
        while reply is not None:
            self._sort_in(reply)
            reply, self._rest = take_reply(self._rest, self._count)

    def _sort_in(self, reply: Reply) -> None:
        turn = self._turns.get(reply.servo)
        known = self._found.get(reply.servo)
        if turn is None or reply in (known, self._echo):
            return
        if known is not None:
            self._doubtful.add(reply.servo)
        self._found = {s: r for s, r in self._found.items() if self._turns[s] < turn}
        self._found[reply.servo] = reply


def _frame(servo: int, instruction: Instruction, parameters: bytes) -> bytes:
    body = bytes((servo, len(parameters) + 2, instruction)) + parameters
    return HEADER + body + bytes((_checksum(body),))


def _checksum(body: bytes) -> int:
    return ~sum(body) & 0xFF
