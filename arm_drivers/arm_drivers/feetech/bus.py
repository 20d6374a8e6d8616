"""Requests to the servos of a bus and their replies, each with a deadline."""

from collections.abc import Mapping, Sequence

from arm_drivers.errors import DeviceError, ReplyError
from arm_drivers.feetech.frames import (
    AROUND_DATA,
    Reply,
    ReplyCollector,
    read_request,
    sync_read_request,
    sync_write_request,
    write_request,
)
from arm_drivers.feetech.registers import Register
from arm_drivers.serial_line import SerialLine

READS = 3
"""How often a read is tried. A write is never repeated: a reply may be lost that the servo sent."""


class FeetechBus:
    """The servos on one line. One thread at a time.

    Attributes:
        line: the serial line.
    """

    def __init__(self, line: SerialLine, reply_timeout_s: float) -> None:
        """Use an open line.

        Args:
            line: the serial line.
            reply_timeout_s: how long a servo and the adapter may take beside the time on the wire.
        """
        self.line = line
        self._reply_timeout_s = reply_timeout_s
        self._last_read = (0, 0)

    def read(self, servo: int, address: int, count: int) -> Reply:
        """Return `count` bytes of a servo's memory.

        Raises:
            ReplyError: there was no sound reply to any of three requests.
            PortError: the port has gone.
        """
        heard = False
        for _ in range(READS):
            collector = self._collect(read_request(servo, address, count), (servo,), address, count)
            for reply in collector.replies().values():
                return reply
            heard = heard or collector.heard
        raise ReplyError(
            f"servo {servo} replies, but never soundly: two servos have this id, or the line is bad"
            if heard
            else f"servo {servo} does not answer",
            heard,
        )

    def read_all(self, servos: Sequence[int], address: int, count: int) -> dict[int, Reply]:
        """Return `count` bytes of the memory of each servo that replies to one request.

        Raises:
            PortError: the port has gone.
        """
        request = sync_read_request(servos, address, count)
        return self._collect(request, servos, address, count).replies()

    def write(self, servo: int, register: Register, value: int) -> None:
        """Store a value, and read it back.

        Raises:
            DeviceError: the servo holds another value afterwards.
            ReplyError: it does not answer.
            PortError: the port has gone.
        """
        self.line.send(write_request(servo, register.address, register.encode(value)))
        held = register.decode(
            self.read(servo, register.address, register.size).data, register.address
        )
        if held != value:
            raise DeviceError(
                f"servo {servo} was told {register.name} {value}, but it holds {held}"
            )

    def write_all(self, register: Register, values: Mapping[int, int]) -> None:
        """Store a value in each servo by one request, to which none replies.

        Raises:
            PortError: the port has gone.
        """
        data = {servo: register.encode(value) for servo, value in values.items()}
        self.line.send(sync_write_request(register.address, data))

    def _collect(
        self, request: bytes, servos: Sequence[int], address: int, count: int
    ) -> ReplyCollector:
        """Send a request, and take replies until all are here or the time is over."""
        last, self._last_read = self._last_read, (address, count)
        if last[0] != address and last[1] == count:
            # A late reply with another register of the same length would pass every check.
            self.line.wait_for_silence(self._reply_timeout_s)
        collector = ReplyCollector(request, servos, count)
        self.line.send(request)
        wire_s = self.line.wire_s(len(request) + (count + AROUND_DATA) * len(servos))
        deadline_s = self.line.now_s() + wire_s + self._reply_timeout_s
        # To wake up for each piece that arrives meanwhile costs several times the processor time.
        self.line.sleep(wire_s)
        while not collector.is_complete:
            received = self.line.receive(deadline_s)
            if not received:
                break
            collector.take(received)
        return collector
