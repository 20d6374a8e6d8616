"""The standard streams of a process: opened, and kept free of what libraries print."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO


def open_closed_streams() -> None:
    """Open the standard streams that a shell's `<&-` or `>&-` has closed.

    Otherwise the next file to be opened would get such a stream's number, and receive the output.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            # Opened in this order, each stream gets its usual number.
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115


STDOUT, STDERR = 1, 2


@contextmanager
def library_output_on_stderr() -> Iterator[None]:
    """Reserve stdout for Python: what C libraries write to it goes to stderr.

    Fast DDS logs to stdout, in the middle of JSON or CSV that a script reads.
    """
    python_stdout = sys.stdout
    python_stdout.flush()
    saved_stdout = _stream(os.dup(STDOUT), like=python_stdout)
    os.dup2(STDERR, STDOUT)
    if _writes_to_stdout(python_stdout):
        sys.stdout = saved_stdout
    try:
        yield
    finally:
        sys.stdout = python_stdout
        os.dup2(saved_stdout.fileno(), STDOUT)
        # Comes last because it raises again if the reader of a pipe has gone.
        saved_stdout.close()


def _stream(descriptor: int, like: TextIO) -> TextIO:
    return open(
        descriptor, "w", encoding=like.encoding, errors=like.errors, buffering=1, closefd=True
    )


def _writes_to_stdout(stream: TextIO) -> bool:
    """Return whether a stream writes to the process's stdout, not to a capture of it."""
    try:
        return stream.fileno() == STDOUT
    except (OSError, io.UnsupportedOperation):
        return False
