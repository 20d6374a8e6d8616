"""The socket on which processes report their readiness and status.

The protocol is systemd's: a datagram of lines `READY=1` and `STATUS=text` to the address in
NOTIFY_SOCKET, so a program that runs as a service under systemd needs no change. The terminal's
status line shows the status of the processes. This project adds one field: `X_REMARK=text` is shown
to users when everything is ready.
"""

from __future__ import annotations

import os
import socket
import struct
from collections.abc import Callable

_CREDENTIALS = struct.Struct("iII")
MAX_DATAGRAM_BYTES = 4096


class NotifySocket:
    """Receives notifications; belongs to the loop's thread.

    The address is abstract, so no file is left behind. The kernel gives the sender of each message.

    Args:
        on_notification: called with the sender's process id and the fields of its message.
    """

    def __init__(self, on_notification: Callable[[int, dict[str, str]], None]) -> None:
        name = f"launch_py-{os.getpid()}-{os.urandom(4).hex()}"
        self.address = f"@{name}"
        self._on_notification = on_notification
        self._socket = socket.socket(
            socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK | socket.SOCK_CLOEXEC
        )
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
        self._socket.bind(f"\0{name}")

    def fileno(self) -> int:
        """Return the file descriptor to watch for reading."""
        return self._socket.fileno()

    def receive(self) -> None:
        """Receive one message. Call it when the socket is readable."""
        try:
            data, ancillary, _, _ = self._socket.recvmsg(
                MAX_DATAGRAM_BYTES, socket.CMSG_SPACE(_CREDENTIALS.size)
            )
        except BlockingIOError:
            return
        for level, kind, payload in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_CREDENTIALS:
                pid, _, _ = _CREDENTIALS.unpack(payload[: _CREDENTIALS.size])
                self._on_notification(pid, _fields(data))

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def _fields(data: bytes) -> dict[str, str]:
    lines = data.decode("utf-8", errors="replace").splitlines()
    return {key: value for key, _, value in (line.partition("=") for line in lines)}
