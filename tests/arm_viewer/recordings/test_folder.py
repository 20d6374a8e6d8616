"""The recordings that a folder holds."""

import os

import pytest

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.folder import find_recording, listed_recordings, size_of


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "bag_0.mcap").write_bytes(bytes(10))
    (tmp_path / "bag" / "bag_1.mcap").write_bytes(bytes(5))
    (tmp_path / "single.mcap").write_bytes(bytes(7))
    (tmp_path / "notes.txt").write_text("no recording")
    (tmp_path / "empty").mkdir()
    for number, name in enumerate(("bag/bag_0.mcap", "bag/bag_1.mcap", "single.mcap")):
        os.utime(tmp_path / name, (number, number))
    return tmp_path


def test_bags_and_single_files_the_newest_first(folder):
    found = listed_recordings(folder)
    assert [(one.name, one.size_bytes, one.changed_s) for one in found] == [
        ("single.mcap", 7, 2.0),
        ("bag", 15, 1.0),
    ]


def test_runs_are_told_apart_by_their_content(folder):
    run = b"\x89MCAP0\r\n\x01" + bytes(12) + b"arm-run"
    (folder / "bug.run").write_bytes(run)
    (folder / "notes.run").write_text("no recording")
    found = {one.name: one.is_run for one in listed_recordings(folder)}
    assert found == {"bug.run": True, "bag": False, "single.mcap": False}


def test_a_name_leads_to_nothing_outside_the_folder(folder):
    assert find_recording(folder, "bag") == folder / "bag"
    for name in ("../secret.mcap", str(folder / "bag"), "notes.txt", "empty", ""):
        with pytest.raises(PageRecordingError, match="there is no recording"):
            find_recording(folder, name)


def test_a_folder_that_is_gone_has_none(tmp_path):
    assert listed_recordings(tmp_path / "gone") == ()
    assert size_of(tmp_path / "gone") == 0
