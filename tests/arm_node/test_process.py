"""A node process's executor: which failures of it are told."""

import threading

import pytest
from rclpy.impl.implementation_singleton import rclpy_implementation

from arm_node.process import NodeProcess

TIMEOUT_S = 30.0


class FakeExecutor:
    """Raises in `spin` as soon as `fails` is set; one that is shut down goes on to that."""

    def __init__(self) -> None:
        self.fails = threading.Event()
        self.spins = threading.Semaphore(0)

    def spin(self) -> None:
        self.spins.release()
        assert self.fails.wait(TIMEOUT_S)
        self.fails.clear()
        raise rclpy_implementation.InvalidHandle("destruction was requested")

    def shutdown(self, timeout_sec: float) -> None:
        self.fails.set()


@pytest.fixture
def process(monkeypatch) -> NodeProcess:
    monkeypatch.setattr("rclpy.executors.SingleThreadedExecutor", FakeExecutor)
    process = NodeProcess(threading.Event())
    process.start_spinning()
    assert process.executor.spins.acquire(timeout=TIMEOUT_S)
    return process


def test_what_the_end_breaks_is_no_failure(process, caplog):
    process.join_spinning()
    assert not caplog.records


def test_what_breaks_before_the_end_is_told_and_the_executor_goes_on(process, caplog):
    process.executor.fails.set()
    assert process.executor.spins.acquire(timeout=TIMEOUT_S)
    assert [record.getMessage() for record in caplog.records] == [
        "a callback failed; the node goes on"
    ]
    process.join_spinning()
    assert len(caplog.records) == 1
