"""Gives nodes simulation time without /clock: a node from its messages, the simulation its own.

Works around https://github.com/ros2/rclpy/issues/1378: an rclpy node that only listens to /clock
takes a tenth of a core or more, and the process that publishes the time would listen to itself once
for each of its nodes. Made for rclpy 7.1 and 9.1; if `stamp_clock` or `process_clock` is switched
off, the nodes use /clock.
"""

from collections.abc import Callable, Sequence
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time

from arm_node.workarounds.switch import is_on

CLOCK_TOPIC = "/clock"
SET_BACK_MESSAGES = 3
"""Messages in a row that must be older than an earlier one before time counts as set back."""
MAX_GROUPS = 1000
"""Maximum sets of joint names whose newest stamps are remembered."""


class StampClock:
    """Sets a node's clock from the stamps of its messages, if the node uses simulation time.

    A simulation publishes /clock in every control period. For a node that only reacts to messages
    of the same period, their stamps give the same time at half the cost for the node and the
    simulation. A node that switches to simulation time later uses /clock. Executor's thread.

    Time counts as set back, by any amount, when the third message in a row about the same joints is
    older than the newest one about them. So a step back is not noticed earlier, nor in a loop of
    only three messages, nor without messages. A second publisher of the same joints with older
    stamps is not mistaken for a step back if it sends at most two messages between two of the
    first.
    """

    def __init__(self, node: Node) -> None:
        """Unsubscribe from /clock if the node is subscribed to it; otherwise do nothing."""
        clock = node.get_clock()
        self._clock: ROSClock | None = None
        self._heard: dict[tuple[str, ...], tuple[int, int]] = {}
        """By joint names: the newest stamp, and how many messages since then were older."""
        for subscription in list(node.subscriptions) if is_on("stamp_clock") else ():
            if subscription.topic_name == CLOCK_TOPIC and isinstance(clock, ROSClock):
                node.destroy_subscription(subscription)
                self._clock = clock

    def hear(self, names: tuple[str, ...], stamp_ns: int) -> None:
        """Process the stamp of a message about these joints; stamps up to 0 are ignored."""
        if self._clock is None or stamp_ns <= 0:
            return
        newest_ns, older = self._heard.get(names, (0, 0))
        if stamp_ns < newest_ns and older + 1 < SET_BACK_MESSAGES:
            self._heard[names] = (newest_ns, older + 1)
            return
        set_back = stamp_ns < newest_ns
        if set_back or len(self._heard) >= MAX_GROUPS:
            # After a step back, the stamps of other joints are useless as well.
            self._heard.clear()
        self._heard[names] = (stamp_ns, 0)
        if set_back or stamp_ns > self._clock.now().nanoseconds:
            time = Time(nanoseconds=stamp_ns, clock_type=ClockType.ROS_TIME)
            self._clock.set_ros_time_override(time)


USE_SIM_TIME = "use_sim_time"


class ProcessClock(ROSClock):
    """The clock of all nodes of a process that makes simulation time.

    Reading it costs the loop nothing. What rcl itself does with a clock, such as timers and
    sleeping, needs the time in C: that is written from the first use on, once for all nodes.
    """

    def __new__(cls, now_ns: Callable[[], int]) -> "ProcessClock":
        """Make a clock of ROS's type, whose class rclpy chooses itself."""
        clock: Any = ROSClock.__new__(ROSClock)
        clock.__class__ = cls
        return clock

    def __init__(self, now_ns: Callable[[], int]) -> None:
        """Make a clock of a function that returns the time in nanoseconds, on any thread."""
        self._now_ns = now_ns
        self._used_in_c = False
        with super().handle:
            super().handle.set_ros_time_override_is_enabled(True)

    @property
    def handle(self) -> Any:
        """The clock in C, which is asked for only where C reads the time."""
        if not self._used_in_c:
            self._used_in_c = True
            self.advance()
        return super().handle

    @property
    def ros_time_is_active(self) -> bool:
        """True: the time is that of the simulation."""
        return True

    def now(self) -> Time:
        """Return the time of the simulation; any thread."""
        return Time(nanoseconds=self._now_ns(), clock_type=ClockType.ROS_TIME)

    def advance(self) -> None:
        """Wake what waits for the time; called after each change of it, on the loop thread."""
        if self._used_in_c:
            self.set_ros_time_override(self.now())

    def give(self, node: Node) -> None:
        """Make this the clock of a node that uses simulation time."""
        if not is_on("process_clock"):
            return
        for subscription in list(node.subscriptions):
            if subscription.topic_name == CLOCK_TOPIC:
                node.destroy_subscription(subscription)
        node._clock = self  # pyright: ignore[reportPrivateUsage]
        node.add_on_set_parameters_callback(_stay)


def _stay(changed: Sequence[Parameter]) -> SetParametersResult:
    """Refuse another clock: the node is part of the simulation."""
    stays = all(item.value is True for item in changed if item.name == USE_SIM_TIME)
    reason = "" if stays else f"{USE_SIM_TIME} stays true in the process of the simulation"
    return SetParametersResult(successful=stays, reason=reason)
