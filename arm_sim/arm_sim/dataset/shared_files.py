"""Files that episodes share, as in LeRobot, whose loader keeps at most a hundred videos open.

An episode is written at the end of the present file, or begins the next one if that is full.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from arm_sim.dataset.video import VideoFile

FILES_IN_CHUNK = 1000
DATA_FILE_MB, VIDEO_FILE_MB = 100, 200
BYTES_IN_MB = 1_000_000
VIDEO_FILE_S = 900.0
"""LeRobot compares times in float32, whose spacing above 1024 s is more than its tolerance."""
PathOf = Callable[[int, int], Path]
"""Returns the path of a file from the indices of its chunk and of the file in it."""


@dataclass(frozen=True, slots=True)
class FilePlace:
    """The file of an episode.

    Attributes:
        chunk_index: its folder.
        file_index: its number in the folder.
        from_s: time in the file at which the episode begins.
    """

    chunk_index: int
    file_index: int
    from_s: float = 0.0

    @classmethod
    def of(cls, number: int, from_s: float = 0.0) -> "FilePlace":
        """Return the place in the file of a number."""
        return cls(number // FILES_IN_CHUNK, number % FILES_IN_CHUNK, from_s)

    def columns(self, kind: str) -> dict[str, int]:
        """Return what an episode's row says of its file; `kind` is the columns' prefix."""
        return {f"{kind}/chunk_index": self.chunk_index, f"{kind}/file_index": self.file_index}


class TableFiles:
    """Parquet files of rows; each episode is a row group."""

    def __init__(self, path_of: PathOf) -> None:
        self._path_of = path_of
        self._writer: pq.ParquetWriter | None = None
        self._path = Path()
        self._files = 0

    def add(self, rows: pa.Table) -> FilePlace:
        """Write the rows of an episode; return where they are."""
        if self._writer is not None and _is_full(self._path, DATA_FILE_MB):
            self.close()
        if self._writer is None:
            self._path = _new(self._path_of, self._files)
            self._writer = pq.ParquetWriter(self._path, rows.schema, compression="snappy")
            self._files += 1
        self._writer.write_table(rows)
        return FilePlace.of(self._files - 1)

    def close(self) -> None:
        """Complete the present file."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None


class VideoFiles:
    """Videos of one camera.

    Height and width are in pixels, and even.
    """

    def __init__(self, path_of: PathOf, height: int, width: int, fps: int) -> None:
        self._path_of, self._size, self._fps = path_of, (height, width), fps
        self._video: VideoFile | None = None
        self._path = Path()
        self._files = 0

    def add(self, images: Iterable[NDArray[np.uint8]], count: int) -> FilePlace:
        """Write the `count` images of an episode, RGB, (h, w, 3); return where they are."""
        video = self._video
        if video is not None and (
            video.frames + count > VIDEO_FILE_S * self._fps or _is_full(self._path, VIDEO_FILE_MB)
        ):
            self.close()
            video = None
        if video is None:
            self._path = _new(self._path_of, self._files)
            video = self._video = VideoFile(self._path, *self._size, self._fps)
            self._files += 1
        place = FilePlace.of(self._files - 1, video.frames / self._fps)
        for image in images:
            video.add(image)
        return place

    def close(self) -> None:
        """Complete the present file."""
        if self._video is not None:
            self._video.close()
            self._video = None


def _new(path_of: PathOf, number: int) -> Path:
    place = FilePlace.of(number)
    path = path_of(place.chunk_index, place.file_index)
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def _is_full(path: Path, limit_mb: int) -> bool:
    # A video that is still shorter than what its encoder looks ahead is not on the disk.
    return path.exists() and path.stat().st_size >= limit_mb * BYTES_IN_MB
