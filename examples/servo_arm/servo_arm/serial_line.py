"""One question, one answer, over a serial port."""

import os
import select
import termios
import time
import tty


class SerialLineError(Exception):
    """The port cannot be opened, is gone, or did not answer in time; the message says which."""


class SerialLine:
    """An open serial port that speaks in lines. One thread at a time."""

    def __init__(self, device: str, timeout_s: float) -> None:
        """Open a port.

        Args:
            device: such as /dev/ttyUSB0.
            timeout_s: the longest that an answer may take.

        Raises:
            SerialLineError: it cannot be opened, or is no serial port.
        """
        self._device = device
        self._timeout_s = timeout_s
        try:
            self._port = os.open(device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        except OSError as error:
            raise SerialLineError(f"cannot open {device}: {error.strerror}") from error
        try:
            tty.setraw(self._port)
        except termios.error as error:
            os.close(self._port)
            raise SerialLineError(f"{device} is no serial port") from error

    def ask(self, question: str) -> str:
        """Send a line and return the line that comes back.

        Raises:
            SerialLineError: none came in time, or the port is gone.
        """
        try:
            # An answer that came too late last time is not the answer to this question.
            termios.tcflush(self._port, termios.TCIFLUSH)
            os.write(self._port, f"{question}\n".encode())
            return self._read_line(question)
        except (OSError, termios.error) as error:
            raise SerialLineError(f"{self._device} is gone: {error.args[-1]}") from error

    def close(self) -> None:
        """Close the port."""
        os.close(self._port)

    def _read_line(self, question: str) -> str:
        deadline_s = time.monotonic() + self._timeout_s
        received = b""
        while not received.endswith(b"\n"):
            left_s = deadline_s - time.monotonic()
            if left_s <= 0.0 or not select.select([self._port], [], [], left_s)[0]:
                raise SerialLineError(
                    f"{self._device} did not answer '{question}' within {self._timeout_s:g} s"
                )
            chunk = os.read(self._port, 1024)
            if not chunk:
                raise SerialLineError(f"{self._device} is gone: the other end was closed")
            received += chunk
        return received.decode(errors="replace").strip()
