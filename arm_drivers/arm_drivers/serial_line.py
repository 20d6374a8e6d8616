"""A serial line: open it, send a request, receive bytes until a deadline."""

import errno
import os
import select
import termios
import time
from glob import glob

import serial

from arm_drivers.errors import PortError

CHUNK = 4096
WRITE_TIMEOUT_S = 0.1
BITS_PER_BYTE = 10
"""On the wire: a start bit, eight data bits, a stop bit."""
GONE = (OSError, termios.error)
"""What an unplugged port raises: pyserial's own error is an OSError, that of tcflush is not."""


class SerialLine:
    """An open serial port, 8 data bits, no parity, 1 stop bit. One thread at a time.

    Attributes:
        port: its path.
        baud: bits per second.
    """

    def __init__(self, port: str, baud: int) -> None:
        """Open a port for this process alone.

        Raises:
            PortError: it cannot be opened.
        """
        self.port = port
        self.baud = baud
        try:
            self._serial = serial.Serial(port, baud, timeout=0, exclusive=True)
        except (ValueError, *GONE) as error:
            raise PortError(_why_closed(port, baud, error)) from error
        self._file: int = self._serial.fileno()

    def send(self, request: bytes) -> None:
        """Drop what has arrived so far, and send.

        Raises:
            PortError: the port has gone, or accepts no bytes.
        """
        try:
            self._serial.reset_input_buffer()
            # pyserial 3.5's write reports a timeout after it has sent everything, if this process
            # was held up meanwhile.
            left = request
            while left and select.select([], [self._file], [], WRITE_TIMEOUT_S)[1]:
                left = left[os.write(self._file, left) :]
        except GONE as error:
            raise self._gone(error) from error
        if left:
            raise PortError(f"port {self.port} accepts no bytes")

    def receive(self, deadline_s: float) -> bytes:
        """Return the bytes that have arrived; wait for the first until a time of `now_s`.

        Returns:
            The bytes; none at the deadline.

        Raises:
            PortError: the port has gone.
        """
        try:
            left_s = max(0.0, deadline_s - self.now_s())
            if not select.select([self._file], [], [], left_s)[0]:
                return b""
            received = os.read(self._file, CHUNK)
        except GONE as error:
            raise self._gone(error) from error
        if not received:
            raise PortError(f"port {self.port} has gone: its other end was closed")
        return received

    def wait_for_silence(self, silence_s: float) -> None:
        """Drop bytes until none has come for this long.

        Raises:
            PortError: the port has gone.
        """
        while self.receive(self.now_s() + silence_s):
            pass

    def wire_s(self, count: int) -> float:
        """Return how long so many bytes are on the wire."""
        return BITS_PER_BYTE * count / self.baud

    def close(self) -> None:
        """Close the port; any error of a port that has gone is of no interest."""
        try:
            self._serial.close()
        except GONE:
            return

    @staticmethod
    def sleep(duration_s: float) -> None:
        """Let bytes arrive."""
        time.sleep(duration_s)

    @staticmethod
    def now_s() -> float:
        """Return the time that deadlines refer to."""
        return time.monotonic()

    def _gone(self, error: BaseException) -> PortError:
        return PortError(f"port {self.port} has gone: {error.args[-1] if error.args else error}")


def ports() -> tuple[str, ...]:
    """Return the serial ports of USB adapters on this machine, sorted."""
    return tuple(sorted((*glob("/dev/ttyACM*"), *glob("/dev/ttyUSB*"))))


def _why_closed(port: str, baud: int, error: BaseException) -> str:
    code = getattr(error, "errno", None)
    if code in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        return f"no port {port}; this machine has {', '.join(ports()) or 'no USB serial port'}"
    if code in (errno.EACCES, errno.EPERM):
        return (
            f"this user may not open port {port}: sudo usermod -aG dialout $USER, then log in again"
        )
    if code in (errno.EAGAIN, errno.EBUSY):
        return f"port {port} is in use by another program"
    if isinstance(error, ValueError):
        return f"port {port} cannot run at {baud} baud: {error}"
    return f"{port} is not a serial port"
