"""The connection between a simulation and its camera process: one unnamed pair of sockets.

Datagrams in both directions, each starting with a letter. Nothing has a name in the file system,
so nothing can be left behind, and the end of either side is seen by the other.
"""

import contextlib
import os
import select
import socket
import struct
from collections.abc import Iterator
from dataclasses import dataclass

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.snapshot import CameraSnapshot

MODEL = b"M"
SNAPSHOT = b"S"
BACKEND = b"B"
VERSION = struct.Struct("<I")
BUFFER_BYTES = 1 << 20
"""Asked for; the kernel may give less. A snapshot of a robot is some hundred bytes."""
WAIT_MS = 250


@dataclass(frozen=True, slots=True)
class ModelMessage:
    """A new model, from now on: its version, and a file that holds it compiled.

    Attributes:
        version: number of the model.
        file: descriptor of the file; whoever receives the message closes it.
    """

    version: int
    file: int


class FeedEnd:
    """The simulation's end: never blocks. It also owns the other end, to hand it to children.

    `send_snapshot` belongs to the loop thread; the rest is for one thread at a time.
    """

    def __init__(self) -> None:
        self._socket, self._remote = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        # Shared with every process that inherits an end: nobody may change it later.
        self._socket.setblocking(False)
        self._remote.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BUFFER_BYTES)

    @property
    def largest_message(self) -> int:
        """Size in bytes of what surely fits into the emptied connection."""
        return self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) // 2

    @property
    def remote_fd(self) -> int:
        """Descriptor of the end that a camera process inherits."""
        return self._remote.fileno()

    def send_snapshot(self, snapshot: CameraSnapshot) -> bool:
        """Send a state; return False when there is no room, and it is lost."""
        try:
            self._socket.send(SNAPSHOT + snapshot.pack())
        except OSError:
            return False
        return True

    def send_model(self, version: int, file: int) -> bool:
        """Send a model; return False when there is no room."""
        try:
            socket.send_fds(self._socket, [MODEL + VERSION.pack(version)], [file])
        except OSError:
            return False
        return True

    def discard_unread(self) -> None:
        """Take back what no camera process has read, to make room for what counts more."""
        messages, _ended = _receive_all(self._remote)
        for _data, files in messages:
            _close_files(files)

    def backends_tried(self) -> list[str]:
        """Return the backends that the camera process said it would try, since the last call."""
        messages, _ended = _receive_all(self._socket)
        return [data[1:].decode() for data, _files in messages if data[:1] == BACKEND]

    def shut_down(self) -> None:
        """Send nothing more: a camera process reads the end of the stream."""
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close both ends; idempotent."""
        self._socket.close()
        self._remote.close()


class CameraEnd:
    """The camera process's end. `receive` belongs to one thread; `tell_backend` to any."""

    def __init__(self, fd: int) -> None:
        try:
            self._socket = socket.socket(fileno=fd)
        except OSError as error:
            raise CameraError(f"file descriptor {fd} is no socket of a simulation") from error
        self._socket.setblocking(False)
        self._readable = select.poll()
        self._readable.register(self._socket, select.POLLIN)

    def receive(self) -> list[ModelMessage | CameraSnapshot] | None:
        """Wait a moment for messages and return all there are, in order; None after the end.

        Raises:
            CameraError: a message that no simulation of this version sends.
        """
        if not self._readable.poll(WAIT_MS):
            return []
        packed, ended = _receive_all(self._socket)
        if ended and not packed:
            return None
        return [message for data, files in packed for message in _unpack(data, files)]

    def tell_backend(self, backend: str) -> None:
        """Tell the simulation which backend is about to be tried, in case it ends the process."""
        with contextlib.suppress(OSError):
            self._socket.send(BACKEND + backend.encode())

    def close(self) -> None:
        """Close this end; idempotent."""
        self._socket.close()


def _unpack(data: bytes, files: list[int]) -> Iterator[ModelMessage | CameraSnapshot]:
    if data[:1] == MODEL and files:
        yield ModelMessage(VERSION.unpack_from(data, 1)[0], files[0])
        _close_files(files[1:])
        return
    _close_files(files)
    if data[:1] == SNAPSHOT:
        yield CameraSnapshot.unpack(data[1:])


def _receive_all(end: socket.socket) -> tuple[list[tuple[bytes, list[int]]], bool]:
    """Return the datagrams that are there with their files, and whether the stream has ended."""
    messages: list[tuple[bytes, list[int]]] = []
    while True:
        try:
            data, files, _flags, _address = socket.recv_fds(end, BUFFER_BYTES, 1)
        except BlockingIOError:
            return messages, False
        except OSError:
            return messages, True
        if not data:
            return messages, True
        messages.append((data, files))


def _close_files(files: list[int]) -> None:
    for file in files:
        os.close(file)
