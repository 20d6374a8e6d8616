"""The files of LeRobot's dataset format v3.0, and the descriptions of its features."""

from collections.abc import Mapping, Sequence
from typing import Any

from arm_sim.dataset.shared_files import DATA_FILE_MB, FILES_IN_CHUNK, VIDEO_FILE_MB
from arm_sim.dataset.streams import CameraStream, Stream, stamp_feature
from arm_sim.dataset.video import video_info

VERSION = "v3.0"
DATA_PATH = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
VIDEO_PATH = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"
EPISODES_PATH = "meta/episodes/chunk-000/file-000.parquet"
INFO, STATS, TASKS = "meta/info.json", "meta/stats.json", "meta/tasks.parquet"
PROVENANCE = "meta/arm_suite.json"
"""The origin of the rows; LeRobot does not read it."""
STREAMS_PATH = "streams/{name}/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
"""All numbers at their own stamps; LeRobot does not read them."""
INDEX_FEATURES = {
    "timestamp": "float32",
    "frame_index": "int64",
    "episode_index": "int64",
    "index": "int64",
    "task_index": "int64",
}
"""The features that every dataset has besides its own, each one number per row."""


def features_of(streams: Sequence[Stream], fps: int) -> dict[str, Any]:
    """Return the features of a dataset from an episode's streams; other episodes have the same."""
    features: dict[str, Any] = {}
    for stream in streams:
        if isinstance(stream, CameraStream):
            features[stream.name] = {
                "dtype": "video",
                "shape": [stream.height, stream.width, 3],
                "names": ["height", "width", "channels"],
                "info": video_info(stream.height, stream.width, fps),
            }
        else:
            shape = [len(stream.names)]
            features[stream.name] = {
                "dtype": "float32",
                "shape": shape,
                "names": list(stream.names),
            }
    for stream in streams:
        features[stamp_feature(stream.name)] = _number("int64")
    return {**features, **{name: _number(dtype) for name, dtype in INDEX_FEATURES.items()}}


def info_of(
    features: Mapping[str, Any], fps: int, robot: str, episodes: int, frames: int, tasks: int
) -> dict[str, Any]:
    """Return the content of `meta/info.json`."""
    has_video = any(feature["dtype"] == "video" for feature in features.values())
    return {
        "codebase_version": VERSION,
        "robot_type": robot,
        "total_episodes": episodes,
        "total_frames": frames,
        "total_tasks": tasks,
        "chunks_size": FILES_IN_CHUNK,
        "data_files_size_in_mb": DATA_FILE_MB,
        "video_files_size_in_mb": VIDEO_FILE_MB,
        "fps": fps,
        "splits": {"train": f"0:{episodes}"},
        "data_path": DATA_PATH,
        "video_path": VIDEO_PATH if has_video else None,
        "features": dict(features),
    }


def _number(dtype: str) -> dict[str, Any]:
    return {"dtype": dtype, "shape": [1], "names": None}
