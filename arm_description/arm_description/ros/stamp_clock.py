"""Simulation time from the stamps of what a node hears anyway, instead of from /clock."""

from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.time import Time

CLOCK_TOPIC = "/clock"
SET_BACK_MESSAGES = 3
"""So many messages in a row that are older than one before: time was set back."""
MOST_KINDS = 1000
"""Kinds of messages (by the joints they name) whose newest stamps are remembered."""


class StampClock:
    """Sets a node's clock by the stamps of its messages, where it goes by simulation time.

    A simulation publishes /clock in every control period. To a node that only answers messages
    of the same period their stamps tell the same, at half of what it and the simulation spend on
    its listening. A node that comes to use simulation time later on listens to /clock. Executor's
    thread.

    Time was set back, by however little, where the third message in a row about the same joints
    is older than the newest about them. So it is not seen before that, nor in a loop of only
    three, nor while there are none. A second publisher of the same joints with older stamps is
    told from it as long as it sends at most two messages between two of the first.
    """

    def __init__(self, node: Node) -> None:
        """Let go of /clock if the node listens to it; otherwise there is nothing to do."""
        clock = node.get_clock()
        self._clock: ROSClock | None = None
        self._heard: dict[tuple[str, ...], tuple[int, int]] = {}
        """By the joints named: the newest stamp, and how many messages since were older."""
        for subscription in list(node.subscriptions):
            if subscription.topic_name == CLOCK_TOPIC and isinstance(clock, ROSClock):
                node.destroy_subscription(subscription)
                self._clock = clock

    def hear(self, names: tuple[str, ...], stamp_ns: int) -> None:
        """Take note of the stamp of a message about these joints; 0 and below are no time."""
        if self._clock is None or stamp_ns <= 0:
            return
        newest_ns, older = self._heard.get(names, (0, 0))
        if stamp_ns < newest_ns and older + 1 < SET_BACK_MESSAGES:
            self._heard[names] = (newest_ns, older + 1)
            return
        set_back = stamp_ns < newest_ns
        if set_back or len(self._heard) >= MOST_KINDS:
            # Once time was set back, what was heard about other joints is of no use either.
            self._heard.clear()
        self._heard[names] = (stamp_ns, 0)
        if set_back or stamp_ns > self._clock.now().nanoseconds:
            time = Time(nanoseconds=stamp_ns, clock_type=ClockType.ROS_TIME)
            self._clock.set_ros_time_override(time)
