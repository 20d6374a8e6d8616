"""Marks in a recording: moments with a few words, kept in a file beside it."""

import json
import math
import os
from dataclasses import dataclass
from pathlib import Path

from arm_node.user_file import read_bytes
from arm_viewer.errors import PageRecordingError

MAX_MARKS = 200
MAX_TEXT = 100
_MAX_BYTES = 100_000
FILE_SUFFIX = ".marks.json"


@dataclass(frozen=True, slots=True, order=True)
class Mark:
    """A moment, in s from the recording's beginning, and what is there."""

    time_s: float
    text: str


def marks_file(recording: Path) -> Path:
    """Return the file of a recording's marks: beside the file, or in the folder."""
    if recording.is_dir():
        return recording / FILE_SUFFIX.lstrip(".")
    return recording.with_name(recording.name + FILE_SUFFIX)


def read_marks(recording: Path) -> tuple[Mark, ...]:
    """Return the marks of a recording, in order; none if it has no file of marks.

    Raises:
        PageRecordingError: the file cannot be read.
    """
    file = marks_file(recording)
    if not file.exists():
        return ()
    try:
        rows = json.loads(read_bytes(file, _MAX_BYTES))
        marks = [Mark(float(time_s), str(text)[:MAX_TEXT]) for time_s, text in rows]
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise PageRecordingError(f"{file} is not a list of marks: {error}") from None
    return tuple(sorted(mark for mark in marks if math.isfinite(mark.time_s)))[:MAX_MARKS]


def write_marks(recording: Path, marks: tuple[Mark, ...]) -> None:
    """Replace the marks of a recording; the file is always whole.

    Raises:
        PageRecordingError: there are too many, or the file cannot be written.
    """
    if len(marks) > MAX_MARKS:
        raise PageRecordingError(f"a recording takes at most {MAX_MARKS} marks")
    file = marks_file(recording)
    new = file.with_name(file.name + ".new")
    try:
        new.write_text(json.dumps([[mark.time_s, mark.text] for mark in marks]), encoding="utf-8")
        os.replace(new, file)
    except OSError as error:
        raise PageRecordingError(f"cannot write {file}: {error.strerror}") from error
