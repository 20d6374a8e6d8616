"""Keeps what C++ libraries print out of a command's own output."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

STDOUT, STDERR = 1, 2


@contextmanager
def library_output_on_stderr() -> Iterator[None]:
    """Leave stdout to Python: what libraries write there by themselves goes to stderr.

    Fast DDS logs on stdout, in the middle of JSON or CSV that a script reads.
    """
    python_stdout = sys.stdout
    python_stdout.flush()
    own = _stream(os.dup(STDOUT), like=python_stdout)
    os.dup2(STDERR, STDOUT)
    if _writes_to_stdout(python_stdout):
        sys.stdout = own
    try:
        yield
    finally:
        sys.stdout = python_stdout
        os.dup2(own.fileno(), STDOUT)
        # Last: where the reader of a pipe has gone, this raises once more.
        own.close()


def _stream(descriptor: int, like: TextIO) -> TextIO:
    return open(
        descriptor, "w", encoding=like.encoding, errors=like.errors, buffering=1, closefd=True
    )


def _writes_to_stdout(stream: TextIO) -> bool:
    """Return whether a stream is the process's stdout, and not what somebody captures."""
    try:
        return stream.fileno() == STDOUT
    except (OSError, io.UnsupportedOperation):
        return False
