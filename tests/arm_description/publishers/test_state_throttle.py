"""The throttle of joint states, by their own stamps and the joints they name."""

import pytest

from arm_description.publishers.ros_robot_state_publisher import StateThrottle

MS = 1_000_000


def passed(throttle: StateThrottle, names: tuple[str, ...], stamps_ms: list[float]) -> list[float]:
    """Return the stamps that are passed on, at a node time far ahead."""
    result = []
    throttle.went_back(10**18)
    for stamp in stamps_ms:
        if throttle.due(names, round(stamp * MS)):
            throttle.record_used(names, round(stamp * MS))
            result.append(stamp)
    return result


def test_at_20_hz_every_fifth_of_100_hz_is_used():
    stamps = [1000.0 + 10 * n for n in range(16)]
    assert passed(StateThrottle(20.0), ("j",), stamps) == [1000, 1050, 1100, 1150]


def test_a_stamp_that_does_not_advance_is_dropped():
    assert passed(StateThrottle(20.0), ("j",), [1000, 1000, 999, 0]) == [1000]


def test_a_stamp_of_zero_is_dropped():
    assert passed(StateThrottle(20.0), ("j",), [0.0]) == []


def test_frequency_zero_passes_every_stamp_that_is_not_older():
    assert passed(StateThrottle(0.0), ("j",), [1000, 1000, 1001, 999]) == [1000, 1000, 1001]


def test_joints_of_other_publishers_are_not_throttled_together():
    throttle = StateThrottle(20.0)
    assert passed(throttle, ("j0",), [1000]) == [1000]
    assert passed(throttle, ("j1",), [1010]) == [1010]
    assert passed(throttle, ("j0",), [1020]) == []


def test_the_oldest_of_the_joints_named_decides():
    throttle = StateThrottle(20.0)
    assert passed(throttle, ("j0",), [1000]) == [1000]
    assert passed(throttle, ("j0", "j1"), [1010]) == [1010]
    assert passed(throttle, ("j0", "j1"), [1020]) == []


@pytest.mark.parametrize(("frequency_hz", "interval_ms"), [(30.0, 33), (1000.0, 1), (0.5, 2000)])
def test_the_interval_is_in_whole_milliseconds(frequency_hz, interval_ms):
    throttle = StateThrottle(frequency_hz)
    assert passed(throttle, ("j",), [5000, 5000 + interval_ms - 0.001]) == [5000]
    assert passed(throttle, ("j",), [5000 + interval_ms]) == [5000 + interval_ms]


@pytest.mark.parametrize("frequency_hz", [5e-324, 1e-300, 1e-20])
def test_a_frequency_next_to_zero_passes_nothing_on(frequency_hz):
    assert passed(StateThrottle(frequency_hz), ("j",), [1000, 4e12]) == []


def test_a_new_frequency_takes_effect_with_the_next_stamp():
    throttle = StateThrottle(1.0)
    assert passed(throttle, ("j",), [1000, 1100]) == [1000]
    throttle.set_frequency(10.0)
    assert passed(throttle, ("j",), [1100]) == [1100]


def test_time_that_goes_back_is_noticed_once_and_all_is_forgotten():
    throttle = StateThrottle(20.0)
    assert passed(throttle, ("j",), [1000]) == [1000]
    assert throttle.went_back(500 * MS)
    assert not throttle.went_back(500 * MS)
    assert throttle.due(("j",), 500 * MS)


def test_a_stamp_ahead_of_the_nodes_time_is_measured_against_that_time():
    throttle = StateThrottle(20.0)
    throttle.went_back(1000 * MS)
    throttle.record_used(("j",), 9000 * MS)
    assert not throttle.due(("j",), 1049 * MS)
    assert throttle.due(("j",), 1050 * MS)


def test_a_message_without_joints_is_due_only_in_the_future():
    throttle = StateThrottle(20.0)
    throttle.went_back(1000 * MS)
    assert not throttle.due((), 1000 * MS)
