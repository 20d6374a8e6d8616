"""Datasets: rows from streams, statistics, files of the written format, faults in them."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_sim import CallError
from arm_sim.dataset import CameraStream, DatasetWriter, Samples, align, check_dataset, shared_files
from arm_sim.dataset.statistics import ImageCounts, statistics_of

MS = 1_000_000
START = 5_000 * MS


def state(stamps_ms: list[int], name: str = "observation.state") -> Samples:
    stamps = START + np.array(stamps_ms, dtype=np.int64) * MS
    values = np.stack([np.array(stamps_ms) * 0.001, np.ones(len(stamps_ms))], axis=1)
    return Samples(name, stamps, values.astype(np.float32), ("j0.pos", "j1.pos"))


def camera(stamps_ms: list[int]) -> CameraStream:
    def images() -> Iterator[np.ndarray]:
        for number in range(len(stamps_ms)):
            image = np.zeros((48, 64, 3), dtype=np.uint8)
            image[:, :, 0] = 40 * number
            yield image

    stamps = START + np.array(stamps_ms, dtype=np.int64) * MS
    return CameraStream("observation.images.front", stamps, 48, 64, images)


def test_a_stream_of_the_rows_rate_has_one_message_in_each():
    rows = align([state([0, 10, 20, 30])], 0)
    assert (rows.fps, rows.length) == (100, 4)
    assert rows.rows[0].tolist() == [0, 1, 2, 3]
    assert str(rows.uses[0]) == "observation.state: 4 messages, one in each row"


def test_rows_take_the_latest_message_and_count_what_that_costs():
    images, states, actions = camera([0, 50, 100, 150]), state(list(range(0, 200, 20))), state([7])
    rows = align([images, states, replace(actions, name="action")], 0)
    assert rows.fps == 20
    assert rows.start_ns == START + 50 * MS, "the first row has a message of each stream"
    assert [one.tolist() for one in rows.rows] == [[1, 2, 3], [2, 5, 7], [0, 0, 0]]
    assert [use.is_exact for use in rows.uses] == [True, False, False]
    assert str(rows.uses[1]) == (
        "observation.state: 6 messages, 3 in no row; 0 rows repeat a message; up to 10.0 ms old"
    )
    assert "2 rows repeat a message; up to 143.0 ms old" in str(rows.uses[2])


def test_frames_of_control_periods_are_one_in_each_row():
    stamps = [10 * -(-100 * k // 30) for k in range(31)]
    rows = align([camera(stamps), state(list(range(0, 1010, 10)))], 0)
    assert (rows.fps, rows.length) == (30, 31)
    assert all(use.oldest_s == 0.0 and not use.repeated for use in rows.uses)
    assert rows.uses[0].is_exact
    assert rows.jitter_s == pytest.approx(0.0067, abs=1e-4)


def test_lost_frames_do_not_change_the_rate():
    stamps = [10 * -(-100 * k // 30) for k in range(60) if k % 3]
    rows = align([camera(stamps)], 0)
    assert rows.fps == 30
    assert rows.uses[0].left_out == 0
    assert rows.uses[0].repeated == 19


def test_a_pause_of_the_reference_repeats_its_last_message():
    rows = align([state([0, 10, 20, 30, 70, 80])], 0)
    assert rows.fps == 100
    assert rows.rows[0].tolist() == [0, 1, 2, 3, 3, 3, 3, 4, 5]
    assert rows.uses[0].repeated == 3


@pytest.mark.parametrize(
    ("streams", "fps", "problem"),
    [
        ([state([0])], None, "only one message, so it has no rate; give --fps"),
        ([state([0, 10]), state([50], "action")], None, "action begins after the last message"),
        ([state([0, 0])], 10, "the stamps of observation.state do not increase"),
        ([state([])], 10, "observation.state has no messages"),
        ([replace(camera([0, 50]), width=63)], None, "63 x 48; video needs even numbers"),
    ],
)
def test_streams_without_rows_are_refused(streams, fps, problem):
    with pytest.raises(CallError, match=problem):
        align(streams, 0, fps)


def test_values_that_are_not_finite_are_refused():
    wrong = state([0, 10])
    wrong.values[1, 0] = np.nan
    with pytest.raises(CallError, match="has values that are not finite"):
        align([wrong], 0)


def test_statistics_of_images_are_by_channel_in_shares_of_white():
    image = np.zeros((400, 400, 3), dtype=np.uint8)
    image[..., 1] = 255
    found = ImageCounts([image]).statistics()
    assert found["mean"].tolist() == [[[0.0]], [[1.0]], [[0.0]]]


@given(st.lists(st.integers(0, 255), min_size=1, max_size=60))
def test_statistics_of_images_are_those_of_their_values(reds):
    image = np.zeros((1, len(reds), 3), dtype=np.uint8)
    image[0, :, 0] = reds
    found, wanted = (
        ImageCounts([image]).statistics(),
        statistics_of(np.array(reds)[:, None] / 255.0),
    )
    for name in wanted.keys() - {"count"}:
        assert found[name][0, 0, 0] == pytest.approx(wanted[name][0], abs=1e-9), name


@given(st.lists(st.integers(0, 255), min_size=2, max_size=60), st.data())
def test_counts_of_parts_add_up_to_those_of_the_whole(reds, data):
    cut = data.draw(st.integers(1, len(reds) - 1))
    images = [np.full((1, 1, 3), red, dtype=np.uint8) for red in reds]
    parts = ImageCounts(images[:cut])
    parts.add(ImageCounts(images[cut:]))
    found, wanted = parts.statistics(), ImageCounts(images).statistics()
    assert {name: one.tolist() for name, one in found.items()} == {
        name: one.tolist() for name, one in wanted.items()
    }


@pytest.fixture
def written(tmp_path) -> Path:
    folder = tmp_path / "demo"
    with DatasetWriter(folder, "arm") as writer:
        for shift in (0, 1000):
            times = [shift + 50 * k for k in range(6)]
            streams = [camera(times), state(times), state(times[:1], "action")]
            writer.add_episode(streams, align(streams, 0), "wave", {"bag": f"bag{shift}"})
        writer.finish()
    return folder


def test_a_dataset_keeps_the_format(written):
    assert check_dataset(written) == []
    info = json.loads((written / "meta/info.json").read_text())
    assert (info["codebase_version"], info["fps"], info["total_frames"]) == ("v3.0", 20, 12)
    assert info["features"]["observation.state"]["names"] == ["j0.pos", "j1.pos"]
    rows = pq.read_table(written / "data/chunk-000/file-000.parquet")
    assert rows["index"].to_pylist() == list(range(12))
    rows = rows.slice(6)
    assert rows["stamp_ns.front"].to_pylist()[0] == START + 1000 * MS
    assert rows["stamp_ns.action"].to_pylist() == [START + 1000 * MS] * 6
    assert rows["timestamp"].to_pylist() == pytest.approx([0.05 * k for k in range(6)])
    raw = pq.read_table(written / "streams/action/chunk-000/file-000.parquet")
    assert raw["stamp_ns"].to_pylist() == [START, START + 1000 * MS]
    assert raw["episode_index"].to_pylist() == [0, 1]
    source = json.loads((written / "meta/arm_suite.json").read_text())["episodes"][1]
    assert source["source"] == {"bag": "bag1000"}
    assert source["streams"][2]["repeated"] == 5


def test_the_statistics_of_a_dataset_are_those_of_all_its_frames(tmp_path):
    lengths = (2, 6, 3)
    with DatasetWriter(tmp_path / "demo", "arm") as writer:
        for count in lengths:
            times = [50 * k for k in range(count)]
            add(writer, [camera(times), state(times)])
        writer.finish()
    found = json.loads((tmp_path / "demo/meta/stats.json").read_text())
    rows = pq.read_table(tmp_path / "demo/data")["observation.state"].to_pylist()
    images = [image for count in lengths for image in camera([0] * count).images()]
    wanted = {
        "observation.state": statistics_of(np.array(rows)),
        "observation.images.front": ImageCounts(images).statistics(),
    }
    for feature, statistics in wanted.items():
        assert found[feature] == {name: one.tolist() for name, one in statistics.items()}


def test_the_frames_of_a_video_are_the_images_of_the_rows(written):
    path = written / "videos/observation.images.front/chunk-000/file-000.mp4"
    with av.open(str(path)) as video:
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
    reds = [frame[..., 0].mean() for frame in frames]
    assert reds == pytest.approx([40 * k for k in range(6)] * 2, abs=6)


def test_a_full_file_is_followed_by_the_next_one(tmp_path, monkeypatch):
    monkeypatch.setattr(shared_files, "DATA_FILE_MB", 0)
    monkeypatch.setattr(shared_files, "VIDEO_FILE_S", 0.6)
    monkeypatch.setattr(shared_files, "FILES_IN_CHUNK", 2)
    times = [50 * k for k in range(6)]
    with DatasetWriter(tmp_path / "demo", "arm") as writer:
        add(writer, *[[camera(times), state(times)]] * 5)
        writer.finish()
    assert check_dataset(tmp_path / "demo") == []
    episodes = pq.read_table(tmp_path / "demo/meta/episodes/chunk-000/file-000.parquet").to_pylist()

    def places(kind: str) -> list[tuple[int, int]]:
        return [(one[f"{kind}/chunk_index"], one[f"{kind}/file_index"]) for one in episodes]

    video = "videos/observation.images.front"
    assert places("data") == [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0)]
    assert places(video) == [(0, 0), (0, 0), (0, 1), (0, 1), (1, 0)]
    assert [one[f"{video}/from_timestamp"] for one in episodes] == [0.0, 0.3, 0.0, 0.3, 0.0]


def test_tasks_have_the_index_that_pandas_reads(written):
    schema = pq.read_schema(written / "meta/tasks.parquet")
    assert json.loads(schema.metadata[b"pandas"])["index_columns"] == ["task"]
    assert pq.read_table(written / "meta/tasks.parquet").to_pylist() == [
        {"task_index": 0, "task": "wave"}
    ]


def change_rows(folder: Path, change: Callable[[pa.Table], pa.Table]) -> None:
    path = folder / "data/chunk-000/file-000.parquet"
    pq.write_table(change(pq.read_table(path)), path)


def shift_times(table: pa.Table) -> pa.Table:
    times = pa.array(table["timestamp"].to_numpy() + np.float32(0.01))
    return table.set_column(table.column_names.index("timestamp"), "timestamp", times)


def test_faults_are_found(written):
    change_rows(written, shift_times)
    assert check_dataset(written) == [
        f"episode {number}: the timestamps are not frame / fps" for number in (0, 1)
    ]
    change_rows(written, lambda table: table.drop_columns(["action"]))
    assert "episode 0 has the columns observation.state" in check_dataset(written)[0]
    change_rows(written, lambda table: table.slice(0, 11))
    assert check_dataset(written)[0] == "total_frames is 12, but there are 11"
    (written / "videos/observation.images.front/chunk-000/file-000.mp4").unlink()
    assert "episode 1 has no videos/" in check_dataset(written)[-1]
    (written / "meta/info.json").unlink()
    with pytest.raises(CallError, match="cannot be read as a dataset"):
        check_dataset(written)


def test_a_video_with_other_frames_is_found(written):
    videos = written / "videos/observation.images.front/chunk-000"
    with DatasetWriter(written.with_name("short"), "arm") as writer:
        streams = [camera([0, 50]), state([0, 50]), state([0], "action")]
        writer.add_episode(streams, align(streams, 0), "wave")
        writer.finish()
    short = written.with_name("short") / videos.relative_to(written) / "file-000.mp4"
    (videos / "file-000.mp4").write_bytes(short.read_bytes())
    assert check_dataset(written) == [
        f"episode {number}: not every row has a frame in observation.images.front"
        for number in (0, 1)
    ]


def add(writer: DatasetWriter, *episodes: list) -> None:
    for streams in episodes:
        writer.add_episode(streams, align(streams, 0), "wave")


@pytest.mark.parametrize(
    ("first", "second", "problem"),
    [
        ([state([0, 50])], [camera([0, 50]), state([0, 50])], "observation.images.front"),
        ([state([0, 50])], [state([0, 10])], "100 rows per second, and the earlier ones have 20"),
    ],
)
def test_an_episode_that_differs_is_refused_and_nothing_is_left(tmp_path, first, second, problem):
    with pytest.raises(CallError, match=problem), DatasetWriter(tmp_path / "demo", "arm") as writer:
        add(writer, first, second)
    assert list(tmp_path.iterdir()) == []


def test_a_dataset_without_episodes_or_in_a_folder_that_exists_is_refused(tmp_path):
    with pytest.raises(CallError, match="needs an episode"):
        DatasetWriter(tmp_path / "demo", "arm").finish()
    with pytest.raises(CallError, match="exists"):
        DatasetWriter(tmp_path, "arm")
