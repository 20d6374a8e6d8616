"""The head of a Ray cluster: whether it answers, in bounded time.

`ray.init` takes more than two minutes to say that nothing listens at an address, and ends the
process a minute after the head of its cluster has gone.
"""

import os
import socket
import time
from collections.abc import Callable

from arm_sim.sweep.study import StudyError

CONNECT_S = 5.0
CHECK_EVERY_S = 1.0
PATIENCE_S = 20.0
"""How long the head may be silent. Ray's own limit, at which it ends the process, is 60 s."""

# RFC 9113, 3.4 and 6.5: what a client sends first, with empty settings; the server answers with a
# frame of type 4.
HTTP2_PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes((0, 0, 0, 4, 0, 0, 0, 0, 0))
FRAME_HEADER_BYTES, TYPE_BYTE, SETTINGS = 9, 3, 4


def check_address(address: str) -> None:
    """Check that a gRPC server listens at HOST:PORT, as the head of a Ray cluster does.

    Raises:
        StudyError: nothing listens there, or what listens does not speak gRPC.
    """
    host, port = _host_and_port(address)
    try:
        with socket.create_connection((host, port), CONNECT_S) as connection:
            # Ray's own TLS would not answer in plain text.
            is_head = "RAY_USE_TLS" in os.environ or _speaks_http2(connection)
    except TimeoutError as error:
        raise StudyError(f"no Ray cluster answers at {address} within {CONNECT_S:g} s") from error
    except OSError as error:
        raise StudyError(f"no Ray cluster listens at {address}: {error.strerror}") from error
    if not is_head:
        raise StudyError(f"what listens at {address} is not the head of a Ray cluster")


class HeadWatch:
    """Tells whether the head at HOST:PORT still answers."""

    def __init__(self, address: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._address = address
        self._clock = clock
        self._answers = True
        self._answered_s = self._looked_s = clock()

    def answers(self, looks_now: bool = False) -> bool:
        """Return whether the head answers, as seen at most CHECK_EVERY_S ago, or just now."""
        if looks_now or self._clock() - self._looked_s >= CHECK_EVERY_S:
            try:
                check_address(self._address)
                self._answers = True
            except StudyError:
                self._answers = False
            self._looked_s = self._clock()
        if self._answers:
            self._answered_s = self._looked_s
        return self._answers

    def check(self) -> None:
        """Check that the head has answered lately.

        Raises:
            StudyError: it has not for PATIENCE_S.
        """
        if not self.answers() and self._clock() - self._answered_s >= PATIENCE_S:
            raise StudyError(
                f"the Ray cluster has gone: its head at {self._address} has not answered for "
                f"{PATIENCE_S:g} s; the same command goes on when it is back"
            )


def _host_and_port(address: str) -> tuple[str, int]:
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536 or "/" in host:
        raise StudyError(
            f"'{address}' is not the address of a Ray cluster: HOST:PORT of its head, or auto for "
            "the cluster of this machine"
        )
    return host.strip("[]"), int(port)


def _speaks_http2(connection: socket.socket) -> bool:
    """Return whether a server answers as one of HTTP/2, which gRPC runs on."""
    connection.sendall(HTTP2_PREFACE)
    connection.settimeout(CONNECT_S)
    answer = b""
    while len(answer) < FRAME_HEADER_BYTES:
        received = connection.recv(FRAME_HEADER_BYTES - len(answer))
        if not received:
            return False
        answer += received
    return answer[TYPE_BYTE] == SETTINGS
