import resource

import numpy as np
import pytest

from arm_gazebo.errors import RecordingError
from arm_gazebo.recording.run_file import (
    RecordedInput,
    RecordingEnd,
    RunFile,
    RunFileWriter,
    StateBlock,
)


def block(first: int, count: int, interval: int = 1, width: int = 3) -> StateBlock:
    stored = -(-count // interval)
    states = np.random.default_rng(first).normal(size=(stored, width))
    return StateBlock(first, np.arange(count, dtype=np.uint64) + 7, interval, states)


def write(path, *records) -> None:
    writer = RunFileWriter(path, {"made_with": {"mujoco": "4"}})
    for record in records:
        writer.write(record)
        writer.flush()
    writer.close()


def problem_of(path) -> str:
    """Return why a file cannot be read; "" if it can."""
    try:
        list(RunFile(path).records())
    except RecordingError as error:
        return str(error)
    return ""


def test_records_are_read_as_they_were_written(tmp_path):
    path = tmp_path / "a.run"
    given = RecordedInput(3, 0, "pos", "offer", {"values": (1.0, 2.5)}, raised=True)
    first = block(0, 10, interval=4)
    write(path, given, first, RecordingEnd(10, "disk"))
    file = RunFile(path)
    assert file.header["made_with"] == {"mujoco": "4"}
    again, states, end = file.records()
    assert again == given
    assert end == RecordingEnd(10, "disk")
    np.testing.assert_array_equal(states.states, first.states)
    np.testing.assert_array_equal(states.hashes, first.hashes)
    np.testing.assert_array_equal(states.state(4), first.states[1])
    assert states.state(5) is None
    assert states.state(12) is None


def test_a_file_without_an_end_is_read_to_its_last_flush(tmp_path):
    path = tmp_path / "a.run"
    writer = RunFileWriter(path, {})
    writer.write(block(0, 5))
    writer.flush()
    assert [record.first for record in RunFile(path).records()] == [0]
    writer.close()


def test_a_file_cut_off_anywhere_is_read_up_to_there(tmp_path):
    path, cut = tmp_path / "a.run", tmp_path / "cut.run"
    write(path, *(block(10 * i, 10) for i in range(5)), RecordingEnd(50))
    content = path.read_bytes()
    seen = set()
    for size in range(len(content) // 3, len(content), 97):
        cut.write_bytes(content[:size])
        firsts = [r.first for r in RunFile(cut).records() if isinstance(r, StateBlock)]
        assert firsts == list(range(0, 10 * len(firsts), 10))
        seen.add(len(firsts))
    assert seen >= {2, 3, 4, 5}


def test_damaged_bytes_are_a_sentence_or_an_early_end(tmp_path):
    path, bad = tmp_path / "a.run", tmp_path / "bad.run"
    write(path, RecordedInput(0, None, None, "reset", {}), block(0, 10), RecordingEnd(10))
    content = bytearray(path.read_bytes())
    random = np.random.default_rng(1)
    refused = 0
    for _ in range(300):
        damaged = bytearray(content)
        for at in random.integers(8, len(content), 3):
            damaged[at] = random.integers(256)
        bad.write_bytes(damaged)
        message = problem_of(bad)
        assert not message or str(bad) in message
        refused += bool(message)
    assert refused > 0


@pytest.mark.parametrize("content", [b"", b"hello", b"\x89MCAP0\r\n", b"\x00" * 100])
def test_what_is_not_a_recording_is_a_sentence(tmp_path, content):
    path = tmp_path / "other"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match="is not a recording of a run"):
        RunFile(path)


def test_missing_files_and_folders_are_a_sentence(tmp_path):
    with pytest.raises(RecordingError, match="does not exist"):
        RunFile(tmp_path / "nothing.run")
    with pytest.raises(RecordingError, match="is not a file"):
        RunFile(tmp_path)


def test_a_later_format_is_a_sentence(tmp_path, monkeypatch):
    monkeypatch.setattr("arm_gazebo.recording.run_file.FORMATS", (3,))
    write(tmp_path / "a.run")
    monkeypatch.undo()
    with pytest.raises(RecordingError, match="has format 3; this version reads 1 and 2"):
        RunFile(tmp_path / "a.run")


def test_no_file_is_overwritten(tmp_path):
    path = tmp_path / "a.run"
    path.write_text("mine")
    with pytest.raises(RecordingError, match="exists already"):
        RunFileWriter(path, {})
    assert path.read_text() == "mine"


def test_a_folder_that_is_not_there_is_a_sentence(tmp_path):
    with pytest.raises(RecordingError, match="No such file or directory"):
        RunFileWriter(tmp_path / "none" / "a.run", {})


@pytest.mark.parametrize("size", [100, 1_000_000])
def test_a_file_that_does_not_fit_on_the_disk_is_refused_and_removed(tmp_path, size):
    """A limit on the size of files stands for a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (50, before[1]))
    try:
        with pytest.raises(RecordingError, match=r"^cannot write .*run\.arm: File too large$"):
            RunFileWriter(tmp_path / "run.arm", {"model": "x" * size})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list(tmp_path.iterdir()) == []
