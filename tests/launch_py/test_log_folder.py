"""Where logs go and what is in them."""

import os
from pathlib import Path

import pytest

from launch_py.errors import StartError
from launch_py.supervision.log_folder import LogFolder, log_root


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
def test_the_root_is_where_ros_has_it(environ, expected):
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


def test_generated_files_go_with_the_end(tmp_path):
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


def test_a_folder_that_cannot_be_made_is_a_sentence(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(StartError, match=r"cannot make the log folder .*set ROS_LOG_DIR"):
        LogFolder(tmp_path / "file")


def test_a_full_disk_is_an_error_of_that_line_only(folder):
    log = folder.path / "a.log"
    log.symlink_to("/dev/full")
    with pytest.raises(OSError, match="No space left"):
        folder.write("a", "lost")
    folder.write("b", "kept")
    assert (folder.path / "b.log").read_text().endswith(" kept\n")


def test_a_file_that_cannot_be_generated_is_a_sentence(folder):
    (folder.path / "a.yaml").symlink_to("/dev/full")
    with pytest.raises(StartError, match=r"cannot write .*a\.yaml: no space left on device"):
        folder.generate("a.yaml", "x: 1")


def test_an_unknown_home_in_the_root_is_a_folder_of_that_name():
    assert log_root({"ROS_LOG_DIR": "~nobody-of-this-name/log"}) == Path("~nobody-of-this-name/log")
