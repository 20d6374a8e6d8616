"""Requests between the client and the control loop."""

from arm_control.controllers.goals import RequestQueue


def test_takes_nothing_until_it_is_opened():
    queue: RequestQueue[int] = RequestQueue()
    assert not queue.put(1)
    assert not queue
    assert not queue.is_open


def test_keeps_the_order_and_forgets_what_was_taken():
    queue: RequestQueue[int] = RequestQueue()
    queue.open()
    assert queue.put(1)
    assert queue.put(2)
    assert queue
    assert queue.take() == [1, 2]
    assert queue.take() == []


def test_returns_what_is_left_when_it_closes():
    queue: RequestQueue[int] = RequestQueue()
    queue.open()
    queue.put(1)
    assert queue.close() == [1]
    assert not queue.put(2)
    queue.open()
    assert queue.take() == []
