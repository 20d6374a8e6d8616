"""Requests and answers over a serial port."""

import os
import select
import termios
import time
import tty


class SerialLineError(Exception):
    """The port cannot be opened, was disconnected, or did not answer in time."""


class SerialLine:
    """An open serial port with a line protocol. One thread at a time."""

    def __init__(self, device: str, timeout_s: float) -> None:
        """Open a port.

        Args:
            device: path of the device, such as /dev/ttyUSB0.
            timeout_s: how long an answer may take, in s.

        Raises:
            SerialLineError: it cannot be opened, or is not a serial port.
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
            raise SerialLineError(f"{device} is not a serial port") from error

    def request(self, line: str) -> str:
        """Send a line and return the answer.

        Raises:
            SerialLineError: no answer came in time, or the port was disconnected.
        """
        try:
            # Discard a late answer to an earlier request.
            termios.tcflush(self._port, termios.TCIFLUSH)
            os.write(self._port, f"{line}\n".encode())
            return self._read_line(line)
        except (OSError, termios.error) as error:
            raise SerialLineError(f"{self._device} is disconnected: {error.args[-1]}") from error

    def close(self) -> None:
        """Close the port."""
        os.close(self._port)

    def _read_line(self, line: str) -> str:
        deadline_s = time.monotonic() + self._timeout_s
        received = b""
        while not received.endswith(b"\n"):
            left_s = deadline_s - time.monotonic()
            if left_s <= 0.0 or not select.select([self._port], [], [], left_s)[0]:
                raise SerialLineError(
                    f"{self._device} did not answer '{line}' within {self._timeout_s:g} s"
                )
            chunk = os.read(self._port, 1024)
            if not chunk:
                raise SerialLineError(f"{self._device} is disconnected: the other end was closed")
            received += chunk
        return received.decode(errors="replace").strip()
