"""Reports this process's status to its supervisor, with the protocol of sd_notify(3).

A supervisor (launch_py, systemd) names a datagram socket in NOTIFY_SOCKET; without one, nothing is
sent. Known messages: READY=1, STOPPING=1, STATUS=one line for users; launch_py also shows
X_REMARK=one line when everything is ready.
"""

import contextlib
import os
import socket
from collections.abc import Mapping


def notify(message: str, environ: Mapping[str, str] = os.environ) -> None:
    """Send a message to the supervisor, if there is one; never blocks or fails."""
    address = environ.get("NOTIFY_SOCKET", "")
    if not address:
        return
    if address.startswith("@"):
        address = "\0" + address[1:]
    with (
        contextlib.suppress(OSError),
        socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as channel,
    ):
        channel.setblocking(False)
        channel.sendto(message.encode(), address)
