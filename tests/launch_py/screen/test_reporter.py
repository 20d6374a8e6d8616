"""Reports on the screen and in the log files, also if one of them fails."""

import io

import pytest

from launch_py.screen import PlainScreen
from launch_py.screen.log_folder import LogFolder
from launch_py.screen.reporter import OutputRateLimiter, Reporter
from launch_py.testing import FakeClock


@pytest.fixture
def logs(tmp_path):
    logs = LogFolder(tmp_path)
    yield logs
    logs.close()


def test_a_full_disk_is_reported_once_and_the_screen_goes_on(logs):
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


def test_the_log_files_survive_a_closed_screen(logs):
    stream = io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs)
    stream.close()
    reporter.line("a", "seen by nobody", shown=True)
    assert reporter.screen_is_gone
    assert (logs.path / "a.log").read_text().endswith(" seen by nobody\n")


def test_the_screen_shows_the_start_of_a_flood_and_a_count(logs):
    clock, stream = FakeClock(), io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs, rate_limiter=OutputRateLimiter(clock))
    for number in range(10_000):
        reporter.line("flood", str(number), shown=True)
    reporter.line("calm", "not affected", shown=True)
    reporter.report_dropped()  # It goes on: too early.
    shown = stream.getvalue().splitlines()
    count = len(shown) - 1
    assert 1000 < count < 2000
    assert shown[:count] == [f"[flood] {number}" for number in range(count)]
    assert shown[count] == "[calm] not affected"
    clock.advance(2.5)
    reporter.report_dropped()
    reporter.line("flood", "again", shown=True)
    assert stream.getvalue().splitlines()[count + 1 :] == [
        f"[launch] flood: {10_000 - count} lines are not shown here; its log files have the last "
        "of them",
        "[flood] again",
    ]
    assert len((logs.path / "flood.log").read_text().splitlines()) == 10_001


def test_dropped_lines_are_counted_at_the_end(logs):
    stream = io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs, rate_limiter=OutputRateLimiter(FakeClock()))
    reporter.line("a", "x" * 500_000, shown=True)
    reporter.end("stopped", failed=False)
    assert stream.getvalue().splitlines() == [
        "[launch] a: 1 line is not shown here; its log files have the last of them",
        "[launch] stopped",
    ]


def test_many_lines_at_a_pace_that_can_be_read_are_all_shown(logs):
    clock, stream = FakeClock(), io.StringIO()
    reporter = Reporter(PlainScreen(stream), logs, rate_limiter=OutputRateLimiter(clock))
    for number in range(5000):
        reporter.line("a", f"{number}".ljust(100), shown=True)
        clock.advance(0.005)
    reporter.report_dropped(at_end=True)
    assert len(stream.getvalue().splitlines()) == 5000
