"""One call at a time, and patience with a server that is late each time."""

import pytest
from rclpy.task import Future

from arm_viewer.ros import service_caller
from arm_viewer.ros.service_caller import MAX_WAIT_S, ServiceCaller


class Client:
    """A client whose server is there; it remembers what it was asked."""

    def __init__(self):
        self.asked: list[Future] = []

    def service_is_ready(self):
        return True

    def call_async(self, _request):
        self.asked.append(Future())
        return self.asked[-1]

    def remove_pending_request(self, future):
        future.cancel()


class Node:
    """Gives out one client."""

    def __init__(self):
        self.client = Client()

    def create_client(self, _service_class, _service):
        return self.client


@pytest.fixture
def clock(monkeypatch):
    """Return a list whose only number is the time in s."""
    now = [0.0]
    monkeypatch.setattr(service_caller.time, "monotonic", lambda: now[0])
    return now


def test_an_answer_that_is_late_each_time_arrives_in_the_end(clock):
    node, answers = Node(), []
    caller = ServiceCaller(node, object, "/slow")
    late_s = 2.5 * MAX_WAIT_S
    while not answers and len(node.client.asked) < 9:
        asked_s = clock[0]
        assert caller.ask(None, answers.append)
        while clock[0] < asked_s + late_s and not caller.is_overdue():
            assert not caller.ask(None, answers.append)
            clock[0] += 0.1
        if not caller.is_overdue():
            node.client.asked[-1].set_result("here")
    assert (answers, len(node.client.asked)) == (["here"], 3)
    caller.ask(None, answers.append)
    clock[0] += MAX_WAIT_S
    assert caller.is_overdue()
