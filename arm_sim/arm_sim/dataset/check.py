"""Checks a dataset against the documented format LeRobot v3.0, as far as readers rely on it."""

import json
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from arm_sim.dataset import layout
from arm_sim.dataset.video import frame_times_s
from arm_sim.errors import CallError

TOLERANCE_S = 1e-4
"""LeRobot's own tolerance between the time of a row and that of its frame."""


def check_dataset(folder: Path) -> list[str]:
    """Return one sentence for each fault; none for a valid dataset.

    Raises:
        CallError: it is not a dataset, or a file cannot be read.
    """
    try:
        info = json.loads((folder / layout.INFO).read_text(encoding="utf-8"))
        episodes = pq.read_table(folder / layout.EPISODES_PATH).to_pylist()
        rows = _rows_of(folder, info, episodes)
        statistics = json.loads((folder / layout.STATS).read_text(encoding="utf-8"))
        tasks = pq.read_table(folder / layout.TASKS)
    except (OSError, ValueError, KeyError, pa.ArrowException) as error:
        raise CallError(f"{folder} cannot be read as a dataset: {error}") from error
    return [
        *_faults_of_info(info, len(episodes), sum(one.num_rows for one in rows), tasks),
        *_faults_of_rows(info, episodes, rows, tasks.num_rows),
        *_faults_of_statistics(info, statistics),
        *_faults_of_videos(folder, info, episodes),
    ]


def _rows_of(
    folder: Path, info: Mapping[str, Any], episodes: list[dict[str, Any]]
) -> list[pa.Table]:
    """Return the rows of each episode, read from files that hold several."""
    files = [folder / info["data_path"].format(**_place(episode, "data")) for episode in episodes]
    found: list[pa.Table] = []
    left, before = pa.table({}), None
    for number, (file, episode) in enumerate(zip(files, episodes, strict=True)):
        if file != before:
            left, before = pq.read_table(file), file
        is_last = number + 1 == len(files) or files[number + 1] != file
        found.append(left if is_last else left.slice(0, episode["length"]))
        left = left.slice(episode["length"])
    return found


def _place(episode: Mapping[str, Any], kind: str) -> dict[str, int]:
    return {key: episode[f"{kind}/{key}"] for key in ("chunk_index", "file_index")}


def _faults_of_info(
    info: Mapping[str, Any], episodes: int, rows: int, tasks: pa.Table
) -> Iterator[str]:
    if info["codebase_version"] != layout.VERSION:
        yield f"the version is {info['codebase_version']}, not {layout.VERSION}"
    for name, count in (
        ("total_episodes", episodes),
        ("total_frames", rows),
        ("total_tasks", tasks.num_rows),
    ):
        if info[name] != count:
            yield f"{name} is {info[name]}, but there are {count}"
    if info["splits"] != {"train": f"0:{episodes}"}:
        yield f"the splits {info['splits']} do not cover {episodes} episodes"
    if tasks["task_index"].to_pylist() != list(range(tasks.num_rows)):
        yield "the tasks are not in the order of their indices"
    missing = layout.INDEX_FEATURES.keys() - info["features"].keys()
    if missing:
        yield f"features are missing: {', '.join(sorted(missing))}"


def _faults_of_rows(
    info: Mapping[str, Any], episodes: list[dict[str, Any]], tables: list[pa.Table], tasks: int
) -> Iterator[str]:
    features, begin = info["features"], 0
    columns = {name for name, one in features.items() if one["dtype"] != "video"}
    for number, (episode, table) in enumerate(zip(episodes, tables, strict=True)):
        where, length = f"episode {number}", table.num_rows
        if set(table.column_names) != columns:
            yield f"{where} has the columns {', '.join(table.column_names)}"
            continue
        bounds = (episode["episode_index"], episode["dataset_from_index"], episode["length"])
        if bounds != (number, begin, length) or episode["dataset_to_index"] != begin + length:
            yield f"{where} is not where its metadata say"
        if table["index"].to_pylist() != list(range(begin, begin + length)):
            yield f"{where}: the indices do not continue those of the previous episode"
        if table["frame_index"].to_pylist() != list(range(length)):
            yield f"{where}: the frames do not count from 0"
        times = table["timestamp"].to_numpy() - np.arange(length) / info["fps"]
        if np.abs(times).max(initial=0.0) >= TOLERANCE_S:
            yield f"{where}: the timestamps are not frame / fps"
        if not set(table["task_index"].to_pylist()) <= set(range(tasks)):
            yield f"{where} has a task that does not exist"
        yield from _faults_of_values(where, table, features)
        begin += length


def _faults_of_values(where: str, table: pa.Table, features: Mapping[str, Any]) -> Iterator[str]:
    for name in table.column_names:
        column, shape = table[name].combine_chunks(), features[name]["shape"]
        kind = pa.from_numpy_dtype(np.dtype(features[name]["dtype"]))
        wanted = kind if shape == [1] else pa.list_(kind, shape[0])
        if column.type != wanted:
            yield f"{where}: {name} is {column.type}, not {wanted}"
        elif column.null_count or not np.isfinite(_flat(column)).all():
            yield f"{where}: {name} has values that are missing or not finite"


def _flat(column: pa.Array) -> np.ndarray:
    values = column.flatten() if pa.types.is_fixed_size_list(column.type) else column
    return values.to_numpy(zero_copy_only=False)


def _faults_of_statistics(info: Mapping[str, Any], statistics: Mapping[str, Any]) -> Iterator[str]:
    for name, feature in info["features"].items():
        if name not in statistics:
            yield f"there are no statistics of {name}"
            continue
        shape = (3, 1, 1) if feature["dtype"] == "video" else tuple(feature["shape"])
        found = {key: np.array(values) for key, values in statistics[name].items()}
        if any(values.shape != shape for key, values in found.items() if key != "count"):
            yield f"statistics of {name} need the shape {shape}"
        elif not (found["min"] <= found["max"]).all():
            yield f"the minimum of {name} is above its maximum"


def _faults_of_videos(
    folder: Path, info: Mapping[str, Any], episodes: list[dict[str, Any]]
) -> Iterator[str]:
    keys = [name for name, one in info["features"].items() if one["dtype"] == "video"]
    times_of = cache(frame_times_s)
    for key in keys:
        for number, episode in enumerate(episodes):
            place = _place(episode, f"videos/{key}")
            path = folder / info["video_path"].format(video_key=key, **place)
            if not path.exists():
                yield f"episode {number} has no {path.relative_to(folder)}"
                continue
            begin, end = (episode[f"videos/{key}/{side}_timestamp"] for side in ("from", "to"))
            wanted = begin + np.arange(episode["length"]) / info["fps"]
            times = np.array(times_of(path))
            times = times[(times > begin - TOLERANCE_S) & (times < end - TOLERANCE_S)]
            if len(times) != len(wanted) or np.abs(times - wanted).max() >= TOLERANCE_S:
                yield f"episode {number}: not every row has a frame in {key}"
