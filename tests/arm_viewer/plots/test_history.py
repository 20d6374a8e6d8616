"""What is kept of a curve: every peak and every gap, in a bounded space."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_viewer.plots.history import Curves, CurveSamples, GapFinder, History, thinned

MARK = np.nan
values_with_gaps = st.lists(
    st.one_of(st.floats(-1e6, 1e6), st.just(MARK)), min_size=1, max_size=400
)


def samples(values, period_s=0.002):
    return CurveSamples(100.0 + period_s * np.arange(len(values)), np.array(values, float))


@given(values_with_gaps, st.integers(1, 50))
def test_thinning_keeps_the_extremes_of_each_span_and_every_gap(values, spans):
    whole = samples(values)
    left = thinned(whole, spans)
    numbers = left.values[~np.isnan(left.values)]
    if len(whole.values[~np.isnan(whole.values)]) > 2 * spans:
        assert len(numbers) <= 2 * spans
    # All that is left was there, in its order.
    index = np.searchsorted(whole.times, left.times)
    np.testing.assert_array_equal(whole.times[index], left.times)
    np.testing.assert_array_equal(whole.values[index], left.values)
    # No peak is lost.
    length = (whole.times[-1] - whole.times[0]) or 1.0
    span_of = {
        time: min(int((time - whole.times[0]) * (spans / length)), spans - 1)
        for time in whole.times
    }
    for span in range(spans):
        real = [v for t, v in zip(*both(whole), strict=True) if span_of[t] == span and v == v]
        kept = [v for t, v in zip(*both(left), strict=True) if span_of[t] == span and v == v]
        assert (min(kept), max(kept)) == (min(real), max(real)) if real else not kept
    # Two numbers are joined only if no gap was between them.
    for a, b in zip(range(len(index)), range(1, len(index)), strict=False):
        if not np.isnan(left.values[[a, b]]).any():
            assert not np.isnan(whole.values[index[a] : index[b]]).any()


def both(part):
    return part.times, part.values


@given(st.lists(st.integers(1, 70), min_size=1, max_size=60), st.randoms(use_true_random=False))
def test_a_full_history_keeps_its_peaks_its_gaps_and_its_newest_samples(sizes, random):
    history, capacity = History(64), 64
    whole = samples([random.choice((MARK, *np.linspace(-1.0, 1.0, 50))) for _ in range(sum(sizes))])
    begin = 0
    for size in sizes:
        part = slice(begin, begin + size)
        history.append(whole.times[part], whole.values[part])
        begin += size
    kept = history.since(-np.inf)
    assert len(kept.times) <= capacity
    assert (np.diff(kept.times) > 0).all()
    newest = min(len(whole.times), capacity // 4)
    np.testing.assert_array_equal(kept.values[-newest:], whole.values[-newest:])
    if not np.isnan(whole.values).all():
        assert np.nanmax(kept.values) == np.nanmax(whole.values)
        assert np.nanmin(kept.values) == np.nanmin(whole.values)
    index = np.searchsorted(whole.times, kept.times)
    for a, b in zip(range(len(index)), range(1, len(index)), strict=False):
        if not np.isnan(kept.values[[a, b]]).any():
            assert not np.isnan(whole.values[index[a] : index[b]]).any()


def test_an_hour_at_500_hz_is_covered_evenly():
    history = History(8192)
    times = 0.002 * np.arange(1_800_000)
    for part in np.array_split(times, 900):
        history.append(part, np.sin(part))
    kept = history.since(-np.inf)
    counts, _ = np.histogram(kept.times, bins=60, range=(0.0, 3600.0))
    assert counts.min() > 0.2 * counts[:-1].mean()


def test_only_what_is_newer_is_asked_for():
    history = History()
    history.append(np.array([1.0, 2.0, 3.0]), np.array([1.0, np.inf, 3.0]))
    newer = history.since(1.0)
    np.testing.assert_array_equal(newer.times, [2.0, 3.0])
    np.testing.assert_array_equal(newer.values, [np.nan, 3.0])


def test_a_sample_from_the_past_is_not_lost():
    history = History()
    history.append(np.array([2.0]), np.array([1.0]))
    history.append(np.array([1.5]), np.array([5.0]))
    assert history.since(2.0).values.tolist() == [5.0]


def test_curves_are_kept_by_name_and_forgotten():
    curves = Curves()
    curves.append(np.array([1.0]), {"a": np.array([2.0]), "b": np.array([3.0])})
    curves.keep({"a"})
    assert curves.since("a", 0.0).values.tolist() == [2.0]
    assert not len(curves.since("b", 0.0).values)


def found_gaps(*batches):
    finder = GapFinder()
    found = [finder.with_gaps(np.array(b), np.ones((1, len(b)))) for b in batches]
    return [float(t) for times, columns in found for t in times[np.isnan(columns[0])]]


def test_a_pause_of_a_fast_topic_is_a_gap():
    fast = 0.002 * np.arange(100)
    assert found_gaps(fast, fast + 1.0) == [pytest.approx((0.198 + 1.0) / 2)]
    assert found_gaps(fast, fast + 0.3) == []


def test_a_slow_topic_has_no_gaps_unless_it_pauses():
    assert found_gaps(*([float(k)] for k in range(10))) == []
    assert found_gaps(*([float(k)] for k in (*range(10), 20))) == [14.5]


def test_a_topic_that_becomes_slower_is_a_line_again():
    slower = [[0.002 * k] for k in range(500)] + [[1.0 + k] for k in range(1, 30)]
    assert max(found_gaps(*slower)) < 10.0
