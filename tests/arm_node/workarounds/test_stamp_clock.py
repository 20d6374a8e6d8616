"""Simulation time from the stamps of messages: what moves it, and what sets it back."""

import pytest

from arm_node.workarounds.clocks import MAX_GROUPS, StampClock

pytestmark = [pytest.mark.ros, pytest.mark.workaround("stamp_clock")]

A, B = ("a",), ("b",)


@pytest.fixture
def times(node):
    """Return the node's times after each of some messages (joints, stamp), all in ns."""
    stamp_clock = StampClock(node)

    def hear(*messages: tuple[tuple[str, ...], int]) -> list[int]:
        result = []
        for names, stamp_ns in messages:
            stamp_clock.hear(names, stamp_ns)
            result.append(node.get_clock().now().nanoseconds)
        return result

    return hear


def test_the_newest_stamp_is_the_time(times):
    assert times((A, 10), (B, 15), (A, 12), (A, 20)) == [10, 15, 15, 20]


def test_the_third_older_message_in_a_row_sets_time_back_by_however_little(times):
    assert times((A, 100), (A, 97), (A, 98), (A, 99), (A, 100)) == [100, 100, 100, 99, 100]


def test_two_that_are_late_do_not(times):
    late = [(A, 100), (A, 1), (A, 2), (A, 101), (A, 3), (A, 4), (A, 102)]
    assert times(*late) == [100, 100, 100, 101, 101, 101, 102]


def test_a_publisher_of_other_joints_may_lag(times):
    lagging = [(A, 100), *((B, stamp) for stamp in range(50, 60)), (A, 101)]
    assert times(*lagging) == [100] * 11 + [101]


def test_the_others_follow_the_first_that_notices(times):
    assert times((A, 100), (B, 100), (A, 10), (A, 11), (A, 12), (B, 13))[-2:] == [12, 13]


@pytest.mark.parametrize("no_time", [0, -5])
def test_an_invalid_stamp_neither_moves_it_nor_hides_a_step_back(times, no_time):
    loop = [(A, 100), (A, no_time), (A, 10), (A, no_time), (A, 11), (A, no_time), (A, 12)]
    assert times(*loop) == [100] * 6 + [12]


def test_many_kinds_of_messages_are_not_remembered_for_ever(times):
    kinds = [((str(n),), 100) for n in range(MAX_GROUPS + 1)]
    assert set(times(*kinds)) == {100}
    assert times((A, 101), (A, 1), (A, 2), (A, 3))[-1] == 3


def test_a_node_that_uses_real_time_keeps_it():
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.signals import SignalHandlerOptions

    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node("timed", context=context)
    StampClock(node).hear(A, 2**62)
    assert node.get_clock().now().nanoseconds < 2**62
    node.destroy_node()
    context.try_shutdown()
