"""What the ROS halves of controllers share: the adapter to a node; readings, times as messages."""

import logging
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

import numpy as np
from builtin_interfaces.msg import Duration, Time
from numpy.typing import NDArray
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSPresetProfiles, QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription

from arm_control.controllers.controller import NOT_ACTIVE, Controller
from arm_control.errors import ControllerError
from arm_control.loop.clock import Throttle
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.outbox import Outbox
from arm_control.loop.ros_executor_bridge import run_on_executor
from arm_node.qos import SERVICE_QOS
from arm_node.workarounds.message_template import MessageTemplate, raw_sender

SHORTEST_S, LONGEST_S = -(2.0**31), 2.0**31 - 1.0
"""The range of a Duration message."""
WARNING_INTERVAL_S = 1.0
SYSTEM_DEFAULT = QoSPresetProfiles.SYSTEM_DEFAULT.value


def seconds_of(time: Time | Duration) -> float:
    """Return a stamp or a duration in seconds; exact to 1 ns up to some months."""
    return time.sec + time.nanosec * 1e-9


def duration_parts(time_s: float) -> tuple[int, int]:
    """Return seconds and nanoseconds of a Duration, clamped to its range."""
    nanoseconds = round(min(max(time_s, SHORTEST_S), LONGEST_S) * 1e9)
    return divmod(nanoseconds, 1_000_000_000)


def duration_message(time_s: float) -> Duration:
    """Return a duration as a message, clamped to its range."""
    seconds, nanoseconds = duration_parts(time_s)
    return Duration(sec=seconds, nanosec=nanoseconds)


def time_message(time_s: float) -> Time:
    """Return a time as a stamp."""
    seconds, nanoseconds = divmod(round(time_s * 1e9), 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


class ReadingPublisher:
    """Writes readings into one serialised message; see `ReadingSink`. Loop thread only.

    Args:
        publisher: a publisher of the message's type.
        message: a message with its final names, frame and covariances.
        paths: the fields that receive the numbers of a reading, in order.
        first: how many numbers at the start of a reading are not part of the message.
        outbox: sends the messages of a tick; None sends each at once.
    """

    def __init__(
        self,
        publisher: Publisher,
        message: Any,
        paths: Sequence[str],
        first: int = 0,
        outbox: Outbox | None = None,
    ) -> None:
        self._publisher = publisher
        self._send = raw_sender(publisher)
        self._outbox = outbox
        self._template = MessageTemplate(message)
        self._where = np.concatenate([self._template.indices(path) for path in paths])
        self._shown = slice(first, first + len(self._where))

    def wanted(self) -> bool:
        """Return whether there is a subscriber now; takes about 1 us."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, time_s: float, reading: NDArray[np.float64]) -> None:
        """Publish a reading, shape (n,), stamped with the time of its state."""
        self._template.set_stamps(round(time_s * 1e9))
        self._template.float64[self._where] = reading[self._shown]
        if self._outbox is None:
            self._template.publish(self._publisher)
        else:
            self._outbox.put(self._send, self._template.to_bytes())


ControllerT = TypeVar("ControllerT", bound=Controller[Any])


class ControllerAdapter(ABC, Generic[ControllerT]):
    """Connects a controller's core to its node.

    It is created when the controller is loaded. The methods run on a control-plane thread, never
    while the controller is active. The end points that they create pass messages to the core on the
    executor's thread, and publish its results on the loop thread. Callbacks must not be coroutines:
    rclpy's event-driven executor, which spins the node, runs none.

    Attributes:
        controller: the core.
        node: the controller's node; a single-threaded executor spins it.
        loop: runs the core.
    """

    def __init__(self, controller: ControllerT, node: Node, loop: ControlLoop) -> None:
        self.controller = controller
        self.node = node
        self.loop = loop
        self._said = ""
        self._throttle = Throttle(WARNING_INTERVAL_S)
        self._end_points: list[Publisher | Subscription | Service] = []

    @property
    def executor(self) -> Executor:
        """The executor that spins the node.

        Raises:
            ControllerError: no executor spins it yet.
        """
        if self.node.executor is None:
            raise ControllerError(
                f"no executor spins the node of controller '{self.node.get_name()}'"
            )
        return self.node.executor

    def takes_commands(self, topic: str) -> bool:
        """Return whether a command takes effect now; if not, say so, once until one does again.

        `topic` is where the command came from, such as '~/commands'.
        """
        reason = self.controller.idle_reason
        if reason and reason != self._said:
            logging.getLogger(self.controller.name).warning(
                "commands on %s have no effect: %s%s",
                self.node.resolve_topic_name(topic),
                reason,
                self._remedy() if reason == NOT_ACTIVE else "",
            )
        self._said = reason
        return not reason

    def _remedy(self) -> str:
        namespace = self.node.get_namespace().rstrip("/")
        manager = f" -c {namespace}/controller_manager" if namespace else ""
        name = self.controller.name
        return f"; activate it with: arm control switch_controllers --activate {name}{manager}"

    def warn_dropped(self, what: str, reason: str, level: int = logging.WARNING) -> None:
        """Log why a message was dropped, at most once a second; do nothing if it was not.

        An empty reason means that it was accepted.
        """
        if reason and self._throttle.permits():
            logger = logging.getLogger(self.controller.name)
            logger.log(level, "a %s was dropped: %s", what, reason)

    @abstractmethod
    def on_configure(self, parameters: Any) -> None:
        """Create the end points; the core already has these parameters."""

    def publisher(
        self, message_type: type[Any], topic: str, qos: QoSProfile = SYSTEM_DEFAULT
    ) -> Publisher:
        """Create a publisher that `on_cleanup` destroys."""
        publisher = self.node.create_publisher(message_type, topic, qos)
        self._end_points.append(publisher)
        return publisher

    def subscribe(
        self,
        message_type: type[Any],
        topic: str,
        callback: Callable[[Any], None],
        qos: QoSProfile = SYSTEM_DEFAULT,
        *,
        raw: bool = False,
    ) -> None:
        """Create a subscription that `on_cleanup` destroys."""
        self._end_points.append(
            self.node.create_subscription(message_type, topic, callback, qos, raw=raw)
        )

    def serve(self, service_type: type[Any], name: str, answer: Callable[[Any, Any], Any]) -> None:
        """Create a service that `on_cleanup` destroys."""
        self._end_points.append(
            self.node.create_service(service_type, name, answer, qos_profile=SERVICE_QOS)
        )

    def on_cleanup(self) -> None:
        """Take the sink from the core, and destroy the end points; may be called more than once.

        An adapter that creates end points in another way destroys those here, using `destroy`.
        """
        self.controller.sink = None
        end_points, self._end_points = self._end_points, []
        self.destroy(*end_points)

    def destroy(self, *end_points: Publisher | Subscription | Service) -> None:
        """Destroy end points of the node; call it from a thread other than the executor's.

        The executor destroys them itself: it fails if an end point disappears while it collects
        the entities to wait for.
        """

        def destroy_all() -> None:
            for end_point in end_points:
                if isinstance(end_point, Publisher):
                    self.node.destroy_publisher(end_point)
                elif isinstance(end_point, Subscription):
                    self.node.destroy_subscription(end_point)
                else:
                    self.node.destroy_service(end_point)

        executor = self.node.executor
        if executor is None:
            destroy_all()
        elif end_points:
            run_on_executor(executor, destroy_all)
