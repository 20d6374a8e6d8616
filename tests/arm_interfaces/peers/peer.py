"""A process that serves until SIGTERM, for the tests."""

import signal
import threading
from collections.abc import Callable

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


def run(name: str, create: Callable[[Node], object]) -> None:
    """Create a node, let `create` furnish it, and spin it until SIGTERM comes."""
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node(name, context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    furniture = create(node)
    while not ended.is_set():
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()
    del furniture
    node.destroy_node()
    context.try_shutdown()
