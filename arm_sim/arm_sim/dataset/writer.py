"""Writes demonstrations in LeRobot's dataset format v3.0, without LeRobot itself."""

import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from arm_sim.dataset import layout
from arm_sim.dataset.alignment import Alignment
from arm_sim.dataset.shared_files import FilePlace, PathOf, TableFiles, VideoFiles
from arm_sim.dataset.statistics import ImageCounts, Statistics, images_to_sample, statistics_of
from arm_sim.dataset.streams import CameraStream, Samples, Stream, stamp_feature
from arm_sim.errors import CallError

Column = NDArray[np.generic]


class DatasetWriter:
    """Writes a dataset into a new folder; a context manager.

    The folder appears once the dataset is complete: until `finish` it has another name, and after
    an error it is removed.

    Args:
        folder: the folder to create.
        robot: name of the robot.

    Raises:
        CallError: the folder exists.
    """

    def __init__(self, folder: Path, robot: str) -> None:
        if folder.exists():
            raise CallError(f"{folder} exists; a dataset is written into a new folder")
        self._folder, self._robot = folder, robot
        self._work = folder.with_name(f".{folder.name}.unfinished")
        shutil.rmtree(self._work, ignore_errors=True)
        self._features: dict[str, Any] = {}
        self._fps = 0
        self._tasks: list[str] = []
        self._episodes: list[dict[str, Any]] = []
        self._statistics: list[dict[str, Statistics]] = []
        self._images: dict[str, ImageCounts] = {}
        self._provenance: list[dict[str, Any]] = []
        self._frames = 0
        self._tables: dict[str, TableFiles] = {}
        self._videos: dict[str, VideoFiles] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        if kind is not None:
            with suppress(OSError, ValueError):
                self._close_files()
            shutil.rmtree(self._work, ignore_errors=True)

    def add_episode(
        self,
        streams: Sequence[Stream],
        alignment: Alignment,
        task: str,
        source: Mapping[str, Any] | None = None,
    ) -> None:
        """Write one episode.

        Args:
            streams: what was recorded.
            alignment: its rows.
            task: what the demonstration shows, as a sentence.
            source: where it comes from, for `meta/arm_suite.json`.

        Raises:
            CallError: its features or its rate differ from those of the earlier episodes.
        """
        self._check(layout.features_of(streams, alignment.fps), alignment.fps)
        if task not in self._tasks:
            self._tasks.append(task)
        columns = self._columns(streams, alignment, self._tasks.index(task))
        data = self._files_of("data", layout.DATA_PATH).add(_table(columns, self._features))
        statistics: dict[str, Statistics] = {
            name: statistics_of(_rows(values)) for name, values in columns.items()
        }
        places: dict[str, Any] = data.columns("data")
        for stream, rows in zip(streams, alignment.rows, strict=True):
            if isinstance(stream, CameraStream):
                place, statistics[stream.name] = self._write_video(stream, rows)
                places |= _video_columns(stream.name, place, alignment)
            else:
                self._write_stream(stream)
        self._statistics.append(statistics)
        self._note(alignment, task, places, source or {})

    def _note(
        self, alignment: Alignment, task: str, places: dict[str, Any], source: Mapping[str, Any]
    ) -> None:
        """Record the description of an episode whose files were written."""
        episode, length = len(self._episodes), alignment.length
        self._episodes.append(
            {
                "episode_index": episode,
                "tasks": [task],
                "length": length,
                "dataset_from_index": self._frames,
                "dataset_to_index": self._frames + length,
                "meta/episodes/chunk_index": 0,
                "meta/episodes/file_index": 0,
                **places,
            }
        )
        self._frames += length
        self._provenance.append(
            {
                "source": dict(source),
                "start_ns": alignment.start_ns,
                "jitter_s": alignment.jitter_s,
                "streams": [asdict(use) for use in alignment.uses],
            }
        )

    def finish(self) -> None:
        """Write the description of the dataset, and give the folder its name.

        Raises:
            CallError: there are no episodes.
        """
        if not self._episodes:
            raise CallError("a dataset needs an episode")
        self._close_files()
        info = layout.info_of(
            self._features,
            self._fps,
            self._robot,
            len(self._episodes),
            self._frames,
            len(self._tasks),
        )
        overall = {
            name: _plain(
                self._images[name].statistics()
                if name in self._images
                else statistics_of(self._all_rows(name))
            )
            for name in self._statistics[0]
        }
        self._write_json(layout.INFO, info)
        self._write_json(layout.STATS, overall)
        self._write_json(layout.PROVENANCE, {"episodes": self._provenance})
        self._write(layout.TASKS, _tasks_table(self._tasks))
        self._write(layout.EPISODES_PATH, self._episodes_table())
        self._work.rename(self._folder)

    def _all_rows(self, name: str) -> Column:
        """Return the column of a feature in all episodes, from the written files."""
        column = pq.read_table(self._work / "data", columns=[name])[name]
        values = column.combine_chunks()
        if pa.types.is_fixed_size_list(values.type):
            values = values.flatten()
        return values.to_numpy(zero_copy_only=False).reshape(len(column), -1)

    def _check(self, features: dict[str, Any], fps: int) -> None:
        if not self._features:
            self._features, self._fps = features, fps
        if fps != self._fps:
            raise CallError(
                f"this episode has {fps} rows per second, and the earlier ones have {self._fps}; "
                "give --fps"
            )
        if features != self._features:
            differing = sorted(
                name
                for name in {*features, *self._features}
                if features.get(name) != self._features.get(name)
            )
            raise CallError(
                f"this episode differs from the earlier ones in {', '.join(differing)}; all "
                "episodes of a dataset have the same joints, actions and cameras"
            )

    def _columns(
        self, streams: Sequence[Stream], alignment: Alignment, task: int
    ) -> dict[str, Column]:
        """Return the columns of an episode's rows, in the order of the features."""
        count = alignment.length
        found: dict[str, Column] = {}
        for stream, rows in zip(streams, alignment.rows, strict=True):
            if isinstance(stream, Samples):
                found[stream.name] = stream.values[rows].astype(np.float32)
        for stream, rows in zip(streams, alignment.rows, strict=True):
            found[stamp_feature(stream.name)] = stream.stamps_ns[rows]
        frames = np.arange(count, dtype=np.int64)
        return {
            **found,
            "timestamp": (frames / alignment.fps).astype(np.float32),
            "frame_index": frames,
            "episode_index": np.full(count, len(self._episodes), dtype=np.int64),
            "index": frames + self._frames,
            "task_index": np.full(count, task, dtype=np.int64),
        }

    def _write_video(
        self, camera: CameraStream, rows: NDArray[np.int64]
    ) -> tuple[FilePlace, Statistics]:
        """Write the images of an episode; return where they are, and their statistics."""
        sampled = set(images_to_sample(len(rows)).tolist())
        kept: list[NDArray[np.uint8]] = []

        def frames() -> Iterator[NDArray[np.uint8]]:
            images = enumerate(camera.images())
            number, image = next(images)
            for row, wanted in enumerate(rows.tolist()):
                while number < wanted:
                    number, image = next(images)
                if row in sampled:
                    kept.append(image.copy())
                yield image

        if camera.name not in self._videos:
            path_of = self._path_of(layout.VIDEO_PATH, video_key=camera.name)
            self._videos[camera.name] = VideoFiles(path_of, camera.height, camera.width, self._fps)
        place = self._videos[camera.name].add(frames(), len(rows))
        counts = ImageCounts(kept)
        statistics = counts.statistics()
        if camera.name in self._images:
            self._images[camera.name].add(counts)
        else:
            self._images[camera.name] = counts
        return place, statistics

    def _write_stream(self, stream: Samples) -> None:
        """Write all numbers of a stream at their own stamps."""
        values = pa.FixedSizeListArray.from_arrays(
            pa.array(stream.values.astype(np.float32).reshape(-1)), len(stream.names)
        )
        episodes = pa.array(np.full(len(stream.stamps_ns), len(self._episodes)))
        table = pa.table(
            {
                "episode_index": episodes,
                "stamp_ns": pa.array(stream.stamps_ns),
                stream.name: values,
            }
        )
        self._files_of(stream.name, layout.STREAMS_PATH).add(table)

    def _files_of(self, name: str, path: str) -> TableFiles:
        if name not in self._tables:
            self._tables[name] = TableFiles(self._path_of(path, name=name))
        return self._tables[name]

    def _path_of(self, path: str, **names: str) -> PathOf:
        return lambda chunk, file: (
            self._work / path.format(chunk_index=chunk, file_index=file, **names)
        )

    def _close_files(self) -> None:
        for files in (*self._tables.values(), *self._videos.values()):
            files.close()

    def _episodes_table(self) -> pa.Table:
        rows = [
            {
                **episode,
                **{
                    f"stats/{feature}/{name}": values.tolist()
                    for feature, one in statistics.items()
                    for name, values in one.items()
                },
            }
            for episode, statistics in zip(self._episodes, self._statistics, strict=True)
        ]
        return pa.Table.from_pylist(rows)

    def _path(self, name: str) -> Path:
        path = self._work / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def _write(self, name: str, table: pa.Table) -> None:
        pq.write_table(table, self._path(name), compression="snappy")

    def _write_json(self, name: str, content: Mapping[str, Any]) -> None:
        self._path(name).write_text(json.dumps(content, indent=4) + "\n", encoding="utf-8")


def _table(columns: Mapping[str, Column], features: Mapping[str, Any]) -> pa.Table:
    """Return rows as a table: numbers as they are, vectors as lists of a fixed length."""
    arrays: dict[str, pa.Array] = {}
    for name, values in columns.items():
        if values.ndim == 2 and features[name]["shape"] != [1]:
            flat = pa.array(values.reshape(-1))
            arrays[name] = pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
        else:
            arrays[name] = pa.array(values.reshape(-1))
    return pa.table(arrays)


def _rows(values: Column) -> Column:
    return values.reshape(len(values), -1)


def _video_columns(name: str, place: FilePlace, alignment: Alignment) -> dict[str, Any]:
    return {
        **place.columns(f"videos/{name}"),
        f"videos/{name}/from_timestamp": place.from_s,
        f"videos/{name}/to_timestamp": place.from_s + alignment.length / alignment.fps,
    }


def _plain(statistics: Statistics) -> dict[str, Any]:
    return {name: values.tolist() for name, values in statistics.items()}


def _tasks_table(tasks: Sequence[str]) -> pa.Table:
    """Return the tasks; LeRobot reads them with pandas, whose index is the text."""
    table = pa.table(
        {"task_index": pa.array(range(len(tasks)), pa.int64()), "task": pa.array(tasks)}
    )

    def column(name: str, kind: str, numpy_type: str) -> dict[str, Any]:
        return {
            "name": name,
            "field_name": name,
            "pandas_type": kind,
            "numpy_type": numpy_type,
            "metadata": None,
        }

    pandas = {
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [
            column("task_index", "int64", "int64"),
            column("task", "unicode", "object"),
        ],
        "creator": {"library": "pyarrow", "version": pa.__version__},
        "pandas_version": "2.0.0",
    }
    return table.replace_schema_metadata({b"pandas": json.dumps(pandas).encode()})
