"""The connection between the simulation and its camera process: an unnamed pair of sockets.

Datagrams go in both directions; the first byte of each is its type. Nothing has a name in the
file system, so nothing is left behind after a crash, and each side sees when the other one closes.
"""

import contextlib
import os
import select
import socket
import struct
from collections.abc import Iterable, Iterator

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_node.frozen import frozen

MODEL = b"M"
SNAPSHOT = b"S"
BACKEND = b"B"
PROGRESS = b"P"
VERSION = struct.Struct("<I")
COUNTS = struct.Struct("<qQQ")
BUFFER_BYTES = 1 << 20
"""Requested buffer size; the kernel may grant less. A snapshot of a robot takes some 100 bytes."""
WAIT_MS = 250


@frozen
class ModelMessage:
    """A new compiled model; the snapshots that follow belong to it.

    Attributes:
        version: number of the model.
        file: descriptor of the file that holds the model; the receiver closes it.
    """

    version: int
    file: int


@frozen
class CameraProgress:
    """What the camera process has done with one camera's frames since it started.

    Attributes:
        serial: of the last frame that it has handled; -1 before the first one.
        rendered: how many frames it has rendered and published.
        dropped: how many frames never reached it, or were passed over for newer ones.
    """

    serial: int = -1
    rendered: int = 0
    dropped: int = 0


@frozen
class FeedReport:
    """What the camera process has reported since the last call.

    Attributes:
        backends: the render backends that it has tried.
        progress: the latest figures, one for each camera; empty if there are no new ones.
    """

    backends: list[str]
    progress: tuple[CameraProgress, ...]


class FeedEnd:
    """The simulation's end, which never blocks. It also owns the end that children inherit.

    Call `send_snapshot` on the loop thread only. Call the other methods from one thread at a time.
    """

    def __init__(self) -> None:
        self._socket, self._remote = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        # Every process that inherits an end shares these flags, so no one may change them later.
        self._socket.setblocking(False)
        self._remote.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BUFFER_BYTES)

    @property
    def largest_message(self) -> int:
        """Size in bytes of the largest message that certainly fits into an empty connection."""
        return self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) // 2

    @property
    def remote_fd(self) -> int:
        """Descriptor of the end that a camera process inherits."""
        return self._remote.fileno()

    def send_snapshot(self, snapshot: CameraSnapshot) -> bool:
        """Send a state; return False if there is no room and the state is lost."""
        try:
            self._socket.send(SNAPSHOT + snapshot.pack())
        except OSError:
            return False
        return True

    def send_model(self, version: int, file: int) -> bool:
        """Send a model; return False if there is no room."""
        try:
            socket.send_fds(self._socket, [MODEL + VERSION.pack(version)], [file])
        except OSError:
            return False
        return True

    def discard_unread(self) -> None:
        """Take back the messages that no camera process has read, to make room for newer ones."""
        messages, _ended = _receive_all(self._remote)
        for _data, files in messages:
            _close_files(files)

    def wait_for_answers(self, timeout_s: float) -> None:
        """Wait for a report of the camera process; any thread, while the end is open."""
        select.select([self._socket], [], [], timeout_s)

    def answers(self) -> FeedReport:
        """Return what the camera process has reported since the last call."""
        said = [data for data, _files in _receive_all(self._socket)[0]]
        progress = [data[1:] for data in said if data[:1] == PROGRESS]
        return FeedReport(
            [data[1:].decode() for data in said if data[:1] == BACKEND],
            tuple(CameraProgress(*counts) for counts in COUNTS.iter_unpack(progress[-1]))
            if progress
            else (),
        )

    def shut_down(self) -> None:
        """Stop sending, so that the camera process reads the end of the stream."""
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close both ends; idempotent."""
        self._socket.close()
        self._remote.close()


class CameraEnd:
    """The camera process's end. Call `receive` from one thread, `tell_backend` from any."""

    def __init__(self, fd: int) -> None:
        try:
            self._socket = socket.socket(fileno=fd)
        except OSError as error:
            raise CameraError(f"file descriptor {fd} is not a simulation's socket") from error
        self._socket.setblocking(False)
        self._readable = select.poll()
        self._readable.register(self._socket, select.POLLIN)

    def receive(self) -> list[ModelMessage | CameraSnapshot] | None:
        """Wait up to `WAIT_MS` and return all messages in order; None after the stream's end.

        Raises:
            CameraError: a message is malformed.
        """
        if not self._readable.poll(WAIT_MS):
            return []
        packed, ended = _receive_all(self._socket)
        if ended and not packed:
            return None
        return [message for data, files in packed for message in _unpack(data, files)]

    def tell_backend(self, backend: str) -> None:
        """Tell the simulation which backend is tried next, in case it crashes the process."""
        with contextlib.suppress(OSError):
            self._socket.send(BACKEND + backend.encode())

    def tell_progress(self, progress: Iterable[CameraProgress]) -> None:
        """Tell the simulation how far each camera has come."""
        packed = b"".join(COUNTS.pack(p.serial, p.rendered, p.dropped) for p in progress)
        with contextlib.suppress(OSError):
            self._socket.send(PROGRESS + packed)

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
    """Return the waiting datagrams with their files, and whether the stream has ended."""
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
