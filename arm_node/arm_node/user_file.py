"""Opens the files that users name: only regular files of limited size.

A FIFO blocks until there is a writer and `/dev/zero` never ends, so both are refused before a byte
is read. Every reader of this suite opens its files here.
"""

import os
import stat
from pathlib import Path
from typing import BinaryIO

MAX_TEXT_BYTES = 20_000_000
"""Maximum size of a text file such as a description, a world or parameters."""
KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


class UnusableFileError(OSError):
    """The file exists but must not be read; `strerror` says why, as with any OSError."""

    def __init__(self, problem: str, path: Path) -> None:
        super().__init__(0, problem, str(path))

    def __str__(self) -> str:
        return str(self.strerror)


def open_file(path: Path | str, max_bytes: int | None = None) -> BinaryIO:
    """Open a regular file for reading.

    A file larger than `max_bytes` is refused.

    Raises:
        UnusableFileError: it is not a regular file, or it is too large.
        OSError: it cannot be opened.
        ValueError: the path contains a null character.
    """
    file = Path(path)
    _check(file, os.stat(file), max_bytes)
    # A file that replaces it meanwhile must not block either.
    descriptor = os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    try:
        _check(file, os.fstat(descriptor), max_bytes)
        return os.fdopen(descriptor, "rb")
    except BaseException:  # Nobody else knows the descriptor.
        os.close(descriptor)
        raise


def read_bytes(path: Path | str, max_bytes: int) -> bytes:
    """Return the content of a regular file; raises like `open_file`."""
    with open_file(path, max_bytes) as file:
        size = os.fstat(file.fileno()).st_size
        # Not up to the limit at once: Python would reserve that much memory first.
        content = file.read(size + 1)
        if len(content) > size:
            # Files below /proc report a size of 0, and some of them never end.
            content += file.read(max_bytes + 1 - len(content))
    if len(content) > max_bytes:
        raise _too_large(Path(path), max_bytes)
    return content


def read_text(path: Path | str, max_bytes: int = MAX_TEXT_BYTES) -> str:
    """Return the text of a regular UTF-8 file, with Unix line ends.

    Raises:
        UnicodeDecodeError: the file is not UTF-8.
        OSError: see `open_file`.
    """
    text = read_bytes(path, max_bytes).decode("utf-8")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def check_file(path: Path | str, max_bytes: int | None = None) -> None:
    """Raise like `open_file`; for a library that opens the file by its path."""
    open_file(path, max_bytes).close()


def _check(path: Path, status: os.stat_result, max_bytes: int | None) -> None:
    if not stat.S_ISREG(status.st_mode):
        kind = next((kind for test, kind in KINDS if test(status.st_mode)), "something else")
        raise UnusableFileError(f"it is {kind}, not a regular file", path)
    if max_bytes is not None and status.st_size > max_bytes:
        raise _too_large(path, max_bytes, status.st_size)


def _too_large(path: Path, max_bytes: int, size: int | None = None) -> UnusableFileError:
    has = f"more than {max_bytes}" if size is None else str(size)
    return UnusableFileError(f"it has {has} bytes; at most {max_bytes} are read", path)
