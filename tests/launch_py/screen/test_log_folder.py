"""The location and the content of log files."""

import os
from pathlib import Path

import pytest

from launch_py.errors import StartError
from launch_py.screen.log_folder import LogFolder
from launch_py.system.child_environment import log_root


@pytest.fixture
def folder(tmp_path):
    logs = LogFolder(tmp_path / "root")
    yield logs
    logs.close()


@pytest.mark.parametrize(
    ("environ", "expected"),
    [
        ({"ROS_LOG_DIR": "/a", "ROS_HOME": "/b", "HOME": "/c"}, "/a"),
        ({"ROS_HOME": "/b", "HOME": "/c"}, "/b/log"),
        ({"HOME": "/c"}, "/c/.ros/log"),
        ({"TMPDIR": "/t"}, f"/t/ros-log-{os.getuid()}"),
    ],
)
def test_the_root_is_ros_s_log_folder(environ, expected):
    assert log_root(environ) == Path(expected)


def test_lines_have_the_time_and_no_colours(folder):
    folder.write("a", "\x1b[32mgreen\x1b[0m")
    folder.write("a", "plain")
    first, second = (folder.path / "a.log").read_text().splitlines()
    assert first[2] == ":"
    assert first.endswith(" green")
    assert second.endswith(" plain")


def test_a_name_with_a_slash_is_a_file_name(folder):
    folder.write("left/arm", "x")
    assert (folder.path / "left_arm.log").is_file()


def test_generated_files_are_removed_at_the_end(tmp_path):
    logs = LogFolder(tmp_path)
    path = logs.generate("a.yaml", "x: 1")
    assert path.read_text() == "x: 1"
    logs.close()
    assert not path.exists()


def test_latest_points_to_the_newest(tmp_path, folder):
    latest = tmp_path / "root" / "latest"
    assert latest.resolve() == folder.path.resolve()
    again = LogFolder(tmp_path / "root")
    assert latest.resolve() == again.path.resolve()
    again.close()


def test_a_log_folder_that_cannot_be_created_is_reported(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(StartError, match=r"cannot make the log folder .*set ROS_LOG_DIR"):
        LogFolder(tmp_path / "file")


def test_a_full_disk_is_an_error_for_that_line_only(folder):
    log = folder.path / "a.log"
    log.symlink_to("/dev/full")
    with pytest.raises(OSError, match="No space left"):
        folder.write("a", "lost")
    folder.write("b", "kept")
    assert (folder.path / "b.log").read_text().endswith(" kept\n")


def test_a_file_that_cannot_be_generated_is_reported(folder):
    (folder.path / "a.yaml").symlink_to("/dev/full")
    with pytest.raises(StartError, match=r"cannot write .*a\.yaml: no space left on device"):
        folder.generate("a.yaml", "x: 1")


def test_an_unknown_home_in_the_root_is_a_folder_of_that_name():
    assert log_root({"ROS_LOG_DIR": "~nobody-of-this-name/log"}) == Path("~nobody-of-this-name/log")


def test_only_its_owner_can_read_the_folder(tmp_path):
    before = os.umask(0)
    try:
        logs = LogFolder(tmp_path)
        logs.write("a", "x")
        generated = logs.generate("a.yaml", "x: 1")
    finally:
        os.umask(before)
    assert logs.path.stat().st_mode & 0o777 == 0o700
    assert (logs.path / "a.log").stat().st_mode & 0o777 == 0o600
    assert generated.stat().st_mode & 0o777 == 0o600
    logs.close()


def test_a_process_that_never_stops_leaves_no_more_than_the_limit(tmp_path):
    logs = LogFolder(tmp_path, limit_bytes=2000)
    for number in range(500):
        logs.write("a", f"line {number}")
    files = sorted(logs.path.iterdir())
    assert [file.name for file in files] == ["a.log", "a.log.1"]
    assert 1000 < sum(file.stat().st_size for file in files) <= 2000
    lines = [line.split()[-1] for file in reversed(files) for line in file.read_text().splitlines()]
    assert lines == [str(number) for number in range(500 - len(lines), 500)]
    assert {file.stat().st_mode & 0o777 for file in files} == {0o600}
    logs.close()


def test_a_line_longer_than_the_limit_is_written_alone(tmp_path):
    logs = LogFolder(tmp_path, limit_bytes=100)
    logs.write("a", "short")
    logs.write("a", "x" * 1000)
    logs.write("a", "last")
    assert (logs.path / "a.log").read_text().endswith(" last\n")
    assert len((logs.path / "a.log.1").read_text()) > 1000
    logs.close()


def test_a_log_that_a_process_writes_itself_is_trimmed_too(tmp_path):
    logs = LogFolder(tmp_path, limit_bytes=2000)
    logs.write("a", "own")
    with (logs.path / "python3_1_2.log").open("ab", buffering=0) as rcl:
        rcl.write(b"old" * 1000 + b"newest" * 100)
        logs.trim_others()
        rcl.write(b"and on")
    assert (logs.path / "python3_1_2.log").read_bytes() == b"and on"
    assert (logs.path / "python3_1_2.log.1").read_bytes().endswith(b"oldnewest" + b"newest" * 99)
    assert (logs.path / "python3_1_2.log.1").stat().st_size == 1000
    logs.trim_others()
    assert (logs.path / "python3_1_2.log").read_bytes() == b"and on"
    assert (logs.path / "a.log").read_text().endswith("own\n")
    logs.close()
