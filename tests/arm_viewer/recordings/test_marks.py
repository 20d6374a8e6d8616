"""Marks in a recording and the file that keeps them."""

import pytest

from arm_viewer.errors import PageRecordingError
from arm_viewer.recordings.marks import MAX_MARKS, Mark, marks_file, read_marks, write_marks


@pytest.fixture(params=["folder", "file"])
def recording(request, tmp_path):
    path = tmp_path / "bag.mcap"
    path.mkdir() if request.param == "folder" else path.touch()
    return path


def test_marks_are_kept_beside_the_recording(recording):
    assert read_marks(recording) == ()
    write_marks(recording, (Mark(1.5, "grasped"), Mark(0.5, "")))
    assert read_marks(recording) == (Mark(0.5, ""), Mark(1.5, "grasped"))


@pytest.mark.parametrize("text", ["{", "5", '[["a", "b"]]', "[[1]]", "[" * 10_000])
def test_a_file_that_is_not_a_list_of_marks_is_named(recording, text):
    marks_file(recording).write_text(text)
    with pytest.raises(PageRecordingError, match="is not a list of marks"):
        read_marks(recording)


def test_there_is_a_limit(recording):
    with pytest.raises(PageRecordingError, match=f"at most {MAX_MARKS} marks"):
        write_marks(recording, tuple(Mark(float(n), "") for n in range(MAX_MARKS + 1)))
    assert read_marks(recording) == ()


def test_a_folder_that_is_gone_is_told(tmp_path):
    with pytest.raises(PageRecordingError, match="cannot write"):
        write_marks(tmp_path / "gone" / "bag.mcap", ())
