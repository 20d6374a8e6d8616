"""Back-off, crash loops and limits, with a manual clock."""

import pytest

from launch_py.errors import LaunchFileError
from launch_py.plan.restart_policy import RestartHistory, RestartPolicy
from launch_py.testing import FakeClock


@pytest.fixture
def clock():
    return FakeClock()


def delays_of(history, clock, exit_codes, run_s=0.1):
    delays = []
    for exit_code in exit_codes:
        history.started()
        clock.advance(run_s)
        delays.append(history.ended(exit_code).delay_s)
    return delays


@pytest.mark.parametrize("name", ["first_delay_s", "max_delay_s", "within_s"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), "1", None])
def test_a_duration_that_is_not_a_number_is_refused(name, value):
    with pytest.raises(
        LaunchFileError, match=f"^{name} of a RestartPolicy is .*, not a number of seconds"
    ):
        RestartPolicy("always", **{name: value})


def test_never_is_the_default(clock):
    decision = RestartHistory(RestartPolicy(), clock).ended(1)
    assert (decision.delay_s, decision.gave_up) == (None, None)


def test_on_failure_does_not_restart_a_success(clock):
    assert RestartHistory(RestartPolicy.on_failure(), clock).ended(0).delay_s is None


def test_always_restarts_a_success(clock):
    assert RestartHistory(RestartPolicy.always(), clock).ended(0).delay_s == 0.5


def test_delays_double_up_to_the_maximum(clock):
    history = RestartHistory(RestartPolicy.always(), clock)
    assert delays_of(history, clock, [0] * 6) == [0.5, 1.0, 2.0, 4.0, 8.0, 8.0]


def test_a_long_run_resets_the_delay(clock):
    history = RestartHistory(RestartPolicy.on_failure(), clock)
    assert delays_of(history, clock, [1, 1, 1]) == [0.5, 1.0, 2.0]
    assert delays_of(history, clock, [1], run_s=31.0) == [0.5]


def test_five_failures_in_thirty_seconds_are_a_crash_loop(clock):
    history = RestartHistory(RestartPolicy.on_failure(), clock)
    assert None not in delays_of(history, clock, [3] * 4)
    history.started()
    decision = history.ended(3)
    assert decision.delay_s is None
    assert decision.gave_up is not None
    assert "5 times" in decision.gave_up
    assert "exit code 3" in decision.gave_up


def test_failures_far_apart_are_not_a_crash_loop(clock):
    history = RestartHistory(RestartPolicy.on_failure(), clock)
    assert None not in delays_of(history, clock, [1] * 12, run_s=8.0)


def test_successes_are_not_a_crash_loop(clock):
    history = RestartHistory(RestartPolicy.always(), clock)
    assert None not in delays_of(history, clock, [0] * 20)


def test_max_restarts_limits_the_restarts(clock):
    history = RestartHistory(RestartPolicy("always", max_restarts=2), clock)
    assert delays_of(history, clock, [0, 0]) == [0.5, 1.0]
    decision = history.ended(0)
    assert decision.delay_s is None
    assert decision.gave_up is not None
    assert "2 times" in decision.gave_up


def test_an_unknown_policy_is_refused():
    with pytest.raises(LaunchFileError, match="never, on-failure or always, not 'sometimes'"):
        RestartPolicy("sometimes")  # pyright: ignore[reportArgumentType]
