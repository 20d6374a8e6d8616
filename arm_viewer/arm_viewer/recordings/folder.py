"""The recordings in a folder."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings import run_check
from arm_viewer.recordings.recorded_bag import SUFFIX

MAX_LISTED = 200


@dataclass(frozen=True, slots=True)
class ListedRecording:
    """A recording that can be opened by its name.

    Attributes:
        name: of its folder or file.
        size_bytes: of its files.
        changed_s: when it was last written, in s since 1970.
        is_run: whether it is a run, which is verified, and not a bag.
    """

    name: str
    size_bytes: int
    changed_s: float
    is_run: bool = False


def listed_recordings(folder: Path) -> tuple[ListedRecording, ...]:
    """Return the recordings in a folder, the newest first."""
    try:
        found = [one for path in folder.iterdir() if (one := _listed(path)) is not None]
    except OSError:
        return ()
    found.sort(key=lambda one: (-one.changed_s, one.name))
    return tuple(found[:MAX_LISTED])


def find_recording(folder: Path, name: str) -> Path:
    """Return the path of a recording in a folder.

    Raises:
        PageRecordingError: the folder has no recording of this name.
    """
    if name not in {one.name for one in listed_recordings(folder)}:
        raise PageRecordingError(f"there is no recording '{name}' in {folder}")
    return folder / name


def size_of(path: Path) -> int:
    """Return the size of a recording's files in bytes; 0 as long as there is none."""
    return sum(size for size, _ in _sizes(path))


def _listed(path: Path) -> ListedRecording | None:
    sizes = list(_sizes(path))
    if not sizes:
        return None
    is_run = path.is_file() and run_check.is_run(path)
    if path.suffix == run_check.SUFFIX and not is_run:
        return None
    size, changed_s = sum(size for size, _ in sizes), max(at for _, at in sizes)
    return ListedRecording(path.name, size, changed_s, is_run)


def _sizes(path: Path) -> Iterator[tuple[int, float]]:
    """Yield the size and the time of the last change of each file of a recording."""
    try:
        files = list(path.glob(f"*{SUFFIX}")) if path.is_dir() else [path]
        for file in files:
            if file.suffix in (SUFFIX, run_check.SUFFIX) and file.is_file():
                status = file.stat()
                yield status.st_size, status.st_mtime
    except OSError:
        return
