"""Offers a topic of every message type that is named as an argument, until SIGTERM comes."""

import signal
import sys
import threading
from importlib import import_module

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

ended = threading.Event()
signal.signal(signal.SIGTERM, lambda *_: ended.set())
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = Node("announcer")
for type_name in sys.argv[1:]:
    package, kind, name = type_name.split("/")
    node.create_publisher(getattr(import_module(f"{package}.{kind}"), name), f"/{type_name}", 1)
while not ended.is_set():
    rclpy.spin_once(node, timeout_sec=0.05)
node.destroy_node()
rclpy.try_shutdown()
