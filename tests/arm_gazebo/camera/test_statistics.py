"""Counting of a camera's frames."""

import pytest

from arm_gazebo.camera.pipeline import CameraStatistics
from arm_gazebo.feed.schedule import FrameDue


def count(statistics: CameraStatistics, *frames: tuple[int, int], wanted: bool = True) -> None:
    for number, serial in frames:
        statistics.count_due(FrameDue(0, number, serial), wanted)
        if wanted:
            statistics.count_rendered(0.004)


def test_nothing_wanted_nothing_achieved():
    statistics = CameraStatistics()
    count(statistics, (0, 0), (1, 1), wanted=False)
    report = statistics.report()
    assert report.achieved is None
    assert report.render_s is None
    assert (report.rendered, report.dropped) == (0, 0)


def test_all_frames_rendered():
    statistics = CameraStatistics()
    count(statistics, (5, 5), (6, 6), (7, 7))
    report = statistics.report()
    assert report.achieved == 1.0
    assert report.rendered == 3
    assert report.render_s == pytest.approx(0.004)


def test_a_gap_in_the_serials_is_dropped_frames():
    statistics = CameraStatistics()
    count(statistics, (0, 0), (3, 3))
    report = statistics.report()
    assert report.dropped == 2
    assert report.achieved == pytest.approx(2 / 4)


def test_frames_that_no_tick_took_lower_the_rate_but_are_not_dropped():
    statistics = CameraStatistics()
    count(statistics, (0, 0), (3, 1), (6, 2))
    report = statistics.report()
    assert report.dropped == 0
    assert report.achieved == pytest.approx(3 / 7)


def test_time_that_jumps_back_is_not_a_gap():
    statistics = CameraStatistics()
    count(statistics, (100, 100), (0, 101))
    report = statistics.report()
    assert report.dropped == 0
    assert report.achieved == 1.0


def test_a_report_starts_a_new_window_and_keeps_the_totals():
    statistics = CameraStatistics()
    count(statistics, (0, 0), (2, 2))
    statistics.report()
    count(statistics, (3, 3))
    report = statistics.report()
    assert report.achieved == 1.0
    assert (report.rendered, report.dropped) == (3, 1)
