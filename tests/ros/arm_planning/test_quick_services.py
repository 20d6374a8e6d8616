"""Quick services are answered while all threads of the others are busy."""

import threading
from collections.abc import Iterator

import pytest
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from arm_node.executor_thread import ExecutorThread
from arm_planning.ros.answering import QuickExecutor, QuickServices, SlowExecutor, offer_service

TIMEOUT_S = 30.0
SLOW_THREADS = 2


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield context
    context.try_shutdown()


class Server:
    """A node with a quick service and a slow one, which waits until it is released."""

    def __init__(self, context: Context) -> None:
        self.node = Node("quick_and_slow", context=context)
        self.busy, self.release = threading.Semaphore(0), threading.Event()
        quick = QuickServices()
        offer_service(self.node, Trigger, "/slow", self._slow, group=ReentrantCallbackGroup())
        offer_service(self.node, Trigger, "/quick", self._quick, group=quick)
        slow = SlowExecutor(SLOW_THREADS, context=context)
        slow.add_node(self.node)
        self._threads = (
            ExecutorThread("slow", slow),
            ExecutorThread("quick", QuickExecutor(self.node, quick)),
        )
        for thread in self._threads:
            thread.start()

    def _slow(self, _request: object, answer: Trigger.Response) -> Trigger.Response:
        self.busy.release()
        answer.success = self.release.wait(TIMEOUT_S)
        return answer

    def _quick(self, _request: object, answer: Trigger.Response) -> Trigger.Response:
        answer.message = threading.current_thread().name
        return answer

    def end(self) -> None:
        self.release.set()
        for thread in self._threads:
            thread.stop()
        self.node.destroy_node()


@pytest.fixture
def server(context) -> Iterator[Server]:
    server = Server(context)
    yield server
    server.end()


def test_a_quick_service_answers_while_all_threads_of_the_others_are_busy(context, server):
    asking = Node("asking", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(asking)
    slow, quick = (client(asking, name) for name in ("/slow", "/quick"))
    waiting = [slow.call_async(Trigger.Request()) for _ in range(SLOW_THREADS)]
    for _ in waiting:
        assert server.busy.acquire(timeout=TIMEOUT_S)
    for _ in range(3):
        asked = quick.call_async(Trigger.Request())
        executor.spin_until_future_complete(asked, TIMEOUT_S)
        assert asked.result().message == "quick"
    assert not any(each.done() for each in waiting)
    server.release.set()
    for each in waiting:
        executor.spin_until_future_complete(each, TIMEOUT_S)
        assert each.result().success
    executor.shutdown()
    asking.destroy_node()


def client(node: Node, name: str) -> Client:
    made = node.create_client(Trigger, name)
    assert made.wait_for_service(TIMEOUT_S)
    return made
