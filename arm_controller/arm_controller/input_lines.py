"""Reads lines from a file descriptor in a way that another thread can end."""

import os
import select
from types import TracebackType


class InputLines:
    """Lines of a terminal, pipe or file; a context manager.

    A thread that is blocked in `sys.stdin.readline` cannot be joined, and the interpreter aborts
    when it exits with such a thread; this one waits for the input and for `end` at once.

    Args:
        descriptor: where to read; stays open.
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._wake_read, self._wake_write = os.pipe()
        self._buffer = b""
        self._at_end_of_input = False
        self._ended = False

    def __enter__(self) -> "InputLines":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        os.close(self._wake_read)
        os.close(self._wake_write)

    def read_line(self) -> str | None:
        """Block for the next line, without its line break; None after the last one or `end`.

        A last line without a line break counts. For one reading thread.
        """
        while b"\n" not in self._buffer and not self._at_end_of_input and not self._ended:
            readable, _, _ = select.select([self._descriptor, self._wake_read], [], [])
            if self._descriptor in readable and not self._ended:
                chunk = self._read_chunk()
                self._at_end_of_input = not chunk
                self._buffer += chunk
        if not self._buffer or self._ended:
            return None
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line.decode("utf-8", errors="replace").rstrip("\r")

    def end(self) -> None:
        """Let `read_line` return None, now and from now on. Any thread."""
        self._ended = True
        os.write(self._wake_write, b"x")

    def _read_chunk(self) -> bytes:
        try:
            return os.read(self._descriptor, 4096)
        except OSError:
            # The terminal is gone, or belongs to another job: there is nothing more to read.
            return b""
