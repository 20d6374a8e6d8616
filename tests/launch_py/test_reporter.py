"""What is said twice, on the screen and in the log files, when one of the two is gone."""

import io

import pytest

from launch_py.screen import PlainScreen
from launch_py.supervision.log_folder import LogFolder
from launch_py.supervision.reporter import Reporter


@pytest.fixture
def logs(tmp_path):
    logs = LogFolder(tmp_path)
    yield logs
    logs.close()


def test_log_files_on_a_full_disk_are_said_once_and_the_screen_goes_on(logs):
    (logs.path / "a.log").symlink_to("/dev/full")
    stream = io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs)
    for number in range(3):
        reporter.line("a", f"line {number}", shown=True)
    problem, *lines = stream.getvalue().splitlines()
    assert problem == (
        f"[launch] lines are missing in the log files of {logs.path}: no space left on device"
    )
    assert lines == ["[a] line 0", "[a] line 1", "[a] line 2"]


def test_a_screen_that_is_gone_leaves_the_log_files(logs):
    stream = io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs)
    stream.close()
    reporter.line("a", "seen by nobody", shown=True)
    assert reporter.screen_is_gone
    assert (logs.path / "a.log").read_text().endswith(" seen by nobody\n")
