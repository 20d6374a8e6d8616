"""Cuts the bytes that a process writes into lines."""

from __future__ import annotations

from collections.abc import Iterator

MAX_LINE_BYTES = 65536
"""A longer line is cut: a process that never writes a newline must not fill the memory."""


class LineSplitter:
    """Collects bytes and returns complete lines as text."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> Iterator[str]:
        """Yield the lines that `data` completes."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            yield _text(line)
        while len(self._rest) > MAX_LINE_BYTES:
            line, self._rest = self._rest[:MAX_LINE_BYTES], self._rest[MAX_LINE_BYTES:]
            yield _text(line)

    def finish(self) -> Iterator[str]:
        """Yield what is left without a newline."""
        rest, self._rest = self._rest, b""
        if rest:
            yield _text(rest)


def _text(line: bytes) -> str:
    """Return a line as a terminal would show it: what follows its last carriage return."""
    return line.decode("utf-8", errors="replace").rstrip("\r").rpartition("\r")[2]
