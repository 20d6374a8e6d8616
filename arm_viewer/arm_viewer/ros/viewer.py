"""The node arm_viewer: looks at topics and services for the page, and does what it asks."""

import time
from queue import Empty, SimpleQueue

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.requests import Request
from arm_viewer.ros.controller_observer import ControllerObserver
from arm_viewer.ros.description_observer import DescriptionObserver
from arm_viewer.ros.joint_state_observer import JointStateObserver
from arm_viewer.ros.observer import Observer
from arm_viewer.ros.transform_observer import TransformObserver
from arm_viewer.snapshot import Snapshot

TICK_S = 1.0 / 30.0
DISCOVERY_PERIOD_S = 1.0
DEFAULT_PORT = 8080


class Viewer(Node):
    """Everything of ROS happens in the executor's thread; `latest` and `send` suit any thread."""

    def __init__(self) -> None:
        super().__init__("arm_viewer")
        self.port = int(
            self.declare_parameter(
                "port", DEFAULT_PORT, ParameterDescriptor(description="of the page, on 127.0.0.1")
            ).value
            or 0
        )
        polled = PolledSubscriptions(self)
        self._descriptions = DescriptionObserver(self, polled)
        self._transforms = TransformObserver(self, polled)
        self._joint_states = JointStateObserver(self, polled)
        self._controllers = ControllerObserver(self)
        self._observers: tuple[Observer, ...] = (
            self._descriptions,
            self._transforms,
            self._joint_states,
            self._controllers,
        )
        self._latest = Snapshot()
        self._requests: SimpleQueue[Request] = SimpleQueue()
        self._request_waits = self.create_guard_condition(self._serve)
        self.create_timer(TICK_S, self._collect)
        self.create_timer(DISCOVERY_PERIOD_S, self._discover)

    def latest(self) -> Snapshot:
        """Return what is known by now; from any thread."""
        return self._latest

    def send(self, request: Request) -> None:
        """Have a request served at once; from any thread."""
        self._requests.put(request)
        self._request_waits.trigger()

    def _discover(self) -> None:
        topics = dict(self.get_topic_names_and_types())
        for observer in self._observers:
            observer.discover(topics)

    def _collect(self) -> None:
        now_s = time.monotonic()
        for observer in self._observers:
            observer.collect(now_s)
        self._latest = Snapshot(
            made_s=now_s,
            descriptions=self._descriptions.descriptions,
            transforms=self._transforms.transforms,
            joint_states=self._joint_states.joint_states,
            controllers=self._controllers.controllers,
        )

    def _serve(self) -> None:
        while True:
            try:
                request = self._requests.get_nowait()
            except Empty:
                return
            self.get_logger().debug(f"{request}")
