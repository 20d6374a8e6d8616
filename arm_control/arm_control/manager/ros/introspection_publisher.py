"""Publishes ~/introspection_data and ~/statistics of a controller manager."""

import logging
import threading
from collections.abc import Callable
from concurrent.futures import TimeoutError as FutureTimeoutError
from typing import TYPE_CHECKING, Any

from builtin_interfaces.msg import Time

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.introspection import (
    InterfaceValues,
    ManagerSnapshot,
    ManagerStatistics,
    NamedValues,
)
from arm_node.qos import LATCHED

if TYPE_CHECKING:
    from arm_control.manager.ros.controller_manager_node import ControllerManagerNode

START_S = 3.0
"""Delay after which the topics are created, to keep the start quick."""

WATCH_S = 0.25
"""Interval between two checks for subscribers while there are none."""

INTERFACES_HZ = 100.0
STATISTICS_HZ = 10.0
"""Maximum messages per second of wall time; the statistics cover some seconds."""

LOOP_TIMEOUT_S = 1.0
DEPTH = 10

logger = logging.getLogger("controller_manager")


class IntrospectionPublisher:
    """Publishes while there is a subscriber, on its own thread.

    The loop thread only copies the values of the interfaces, between two cycles.
    """

    def __init__(
        self,
        node: "ControllerManagerNode",
        manager: ControllerManager,
        snapshot: ManagerSnapshot,
        loop: ControlLoop,
    ) -> None:
        """Prepare the thread; `start` starts it."""
        self._node = node
        self._loop = loop
        self._interfaces = InterfaceValues(manager, snapshot)
        self._statistics = ManagerStatistics(manager, snapshot, node.get_name())
        self._rate_hz = min(manager.update_rate_hz, INTERFACES_HZ)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="introspection", daemon=True)

    def start(self) -> None:
        """Start the thread; it creates the topics a moment later."""
        self._thread.start()

    def stop(self) -> None:
        """Stop publishing; the loop may still run or have ended."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        if self._stopping.wait(START_S):
            return
        try:
            interfaces = StatisticsTopic(
                self._node, "~/introspection_data", self._sample_interfaces
            )
            statistics = StatisticsTopic(self._node, "~/statistics", self._sample_statistics)
        except ImportError:
            logger.warning(
                "pal_statistics_msgs is not installed, so there is no ~/introspection_data and no "
                "~/statistics; run 'pip install ./arm_interfaces' from the arm suite's folder"
            )
            return
        turns = max(round(self._rate_hz / STATISTICS_HZ), 1)
        turn = 0
        while True:
            streams = interfaces.streams or statistics.streams
            if self._stopping.wait(1.0 / self._rate_hz if streams else WATCH_S):
                return
            turn = (turn + 1) % turns
            if interfaces.wanted:
                interfaces.publish()
            if statistics.wanted and turn == 0:
                statistics.publish()

    def _sample_interfaces(self) -> tuple[Time, NamedValues] | None:
        future = self._loop.call(lambda: (self._node.stamp(), self._interfaces.sample()))
        try:
            return future.result(LOOP_TIMEOUT_S)
        except FutureTimeoutError:
            future.cancel()
        except LoopStoppedError:
            pass
        return None

    def _sample_statistics(self) -> tuple[Time, NamedValues]:
        return self._node.stamp(), self._statistics.sample()


class StatisticsTopic:
    """The topics `full`, `names` and `values` of one set of numbers; one thread.

    Raises:
        ImportError: pal_statistics_msgs is not installed.
    """

    def __init__(
        self,
        node: "ControllerManagerNode",
        prefix: str,
        sample: Callable[[], tuple[Time, NamedValues] | None],
    ) -> None:
        """Make the publishers; `sample` returns the numbers and their stamp, or None."""
        # Imported here, so that a start does not load these messages.
        from pal_statistics_msgs.msg import Statistic, Statistics, StatisticsNames, StatisticsValues

        self._full = node.create_publisher(Statistics, f"{prefix}/full", DEPTH)
        self._names = node.create_publisher(StatisticsNames, f"{prefix}/names", LATCHED)
        self._values = node.create_publisher(StatisticsValues, f"{prefix}/values", DEPTH)
        self._make_statistic: Callable[..., Any] = Statistic
        self._message = Statistics()
        self._list = StatisticsNames()
        self._numbers = StatisticsValues()
        self._published_names: tuple[str, ...] | None = None
        self._last_stamp: Time | None = None
        self._sample = sample

    @property
    def streams(self) -> bool:
        """Whether there is a subscriber to the numbers."""
        return bool(self._full.get_subscription_count() or self._values.get_subscription_count())

    @property
    def wanted(self) -> bool:
        """Whether there is a subscriber to the numbers or to their names."""
        return self.streams or bool(self._names.get_subscription_count())

    def publish(self) -> None:
        """Publish the current numbers, and their names if they have changed.

        It publishes nothing while time stands still.
        """
        sample = self._sample()
        if sample is None:
            return
        stamp, numbers = sample
        if numbers.names != self._published_names:
            self._publish_names(stamp, numbers.names)
        elif stamp == self._last_stamp:
            return
        self._last_stamp = stamp
        values = numbers.values.tolist()
        if self._values.get_subscription_count():
            self._numbers.header.stamp = stamp
            self._numbers.values = values
            self._values.publish(self._numbers)
        if self._full.get_subscription_count():
            self._message.header.stamp = stamp
            for statistic, value in zip(self._message.statistics, values, strict=True):
                statistic.value = value
            self._full.publish(self._message)

    def _publish_names(self, stamp: Time, names: tuple[str, ...]) -> None:
        self._published_names = names
        self._list.header.stamp = stamp
        self._list.names = list(names)
        self._list.names_version += 1
        self._numbers.names_version = self._list.names_version
        self._message.statistics = [self._make_statistic(name=name) for name in names]
        self._names.publish(self._list)
