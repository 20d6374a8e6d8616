"""The event-driven executor in a thread: what it must survive, and how it ends."""

import threading

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String

from arm_description.publishers.ros_robot_state_publisher import spinning
from arm_node import executor_thread


@pytest.fixture
def node():
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield Node("events", context=context)
    context.try_shutdown()


def test_a_callback_that_raises_is_logged_and_the_next_runs(client, node, caplog):
    texts: list[str] = []
    arrived = threading.Event()

    def take(message: String) -> None:
        texts.append(message.data)
        if message.data == "bad":
            raise ValueError("bad message")
        arrived.set()

    node.create_subscription(String, "texts", take, 10)
    with spinning(node):
        publisher = client.publisher(String, "texts")
        publisher.publish(String(data="bad"))
        publisher.publish(String(data="good"))
        assert arrived.wait(30.0)
    assert texts == ["bad", "good"]
    assert "a callback failed; the node goes on" in caplog.text
    assert "ValueError: bad message" in caplog.text


def test_a_callback_that_does_not_end_is_left_alone(node, caplog, monkeypatch):
    monkeypatch.setattr(executor_thread, "JOIN_TIMEOUT_S", 0.1)
    monkeypatch.setattr(executor_thread, "CALLBACKS_TIMEOUT_S", 0.1)
    entered, go_on = threading.Event(), threading.Event()

    def hang() -> None:
        entered.set()
        go_on.wait(30.0)

    node.create_timer(0.01, hang)
    with spinning(node):
        assert entered.wait(30.0)
    assert "a callback in thread 'events' is still running" in caplog.text
    assert executor_thread.is_spinning()
    go_on.set()
    for thread in threading.enumerate():
        if thread.name == "events":
            thread.join(30.0)
    assert not executor_thread.is_spinning()


def test_timers_run_until_the_end_and_not_after(node):
    ticks = threading.Semaphore(0)
    node.create_timer(0.01, ticks.release)
    with spinning(node):
        for _ in range(5):
            assert ticks.acquire(timeout=30.0)
    while ticks.acquire(blocking=False):
        pass
    assert not ticks.acquire(timeout=0.1)
    assert "events" not in {thread.name for thread in threading.enumerate()}
