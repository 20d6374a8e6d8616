"""Statistics of runs: how often, how long."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.loop.supervision import RunRecord


def record_of(starts_s: list[float], duration_s: float = 0.001, size: int = 100) -> RunRecord:
    record = RunRecord(size)
    for last_s, start_s in pairwise([math.nan, *starts_s]):
        record.add_period(start_s - last_s)
        record.add_duration(duration_s)
    return record


def test_nothing_is_known_before_the_first_run():
    assert RunRecord(5).statistics() is None


def test_a_single_run_has_a_duration_but_no_rate():
    statistics = record_of([3.0]).statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is None
    assert statistics.execution_time_us.mean == pytest.approx(1000.0)


def test_regular_runs_have_their_rate_and_no_deviation():
    statistics = record_of([0.01 * i for i in range(50)]).statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is not None
    assert statistics.periodicity_hz.mean == pytest.approx(100.0)
    assert statistics.periodicity_hz.standard_deviation == pytest.approx(0.0, abs=1e-6)


def test_a_late_run_that_is_made_up_for_does_not_change_the_mean_rate():
    statistics = record_of([0.0, 0.01, 0.0299, 0.03, 0.04]).statistics()
    assert statistics is not None
    rate = statistics.periodicity_hz
    assert rate is not None
    assert rate.mean == pytest.approx(100.0)
    assert rate.minimum == pytest.approx(1 / 0.0199)
    assert rate.maximum == pytest.approx(10_000.0)


def test_old_runs_are_forgotten():
    record = record_of([0.0, 1.0, 2.0], duration_s=0.5, size=10)
    for _ in range(11):
        record.add_period(0.1)
        record.add_duration(0.01)
    statistics = record.statistics()
    assert statistics is not None
    assert statistics.execution_time_us.maximum == pytest.approx(10_000.0)


def test_what_is_cleared_is_forgotten():
    record = record_of([0.0, 60.0])
    record.clear()
    assert record.statistics() is None
    record.add_period(0.01)
    record.add_duration(0.0)
    statistics = record.statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is not None
    assert statistics.periodicity_hz.minimum == pytest.approx(100.0)


def test_setting_the_time_back_is_not_a_period():
    statistics = record_of([5.0, 5.01, 0.0, 0.01]).statistics()
    assert statistics is not None
    assert statistics.periodicity_hz is not None
    assert statistics.periodicity_hz.mean == pytest.approx(100.0)


@given(st.lists(st.floats(1e-4, 10.0), min_size=1, max_size=60))
def test_mean_and_bounds_are_those_of_the_periods(periods_s):
    starts_s = np.concatenate(([0.0], np.cumsum(periods_s))).tolist()
    statistics = record_of(starts_s).statistics()
    assert statistics is not None
    rate = statistics.periodicity_hz
    assert rate is not None
    real = [b - a for a, b in pairwise(starts_s)]
    assert math.isclose(rate.mean, len(real) / sum(real), rel_tol=1e-9)
    assert math.isclose(rate.minimum, 1 / max(real), rel_tol=1e-9)
    assert math.isclose(rate.maximum, 1 / min(real), rel_tol=1e-9)
    assert rate.minimum * (1 - 1e-9) <= rate.mean <= rate.maximum * (1 + 1e-9)
