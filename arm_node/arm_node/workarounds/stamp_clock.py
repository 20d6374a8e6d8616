"""Takes simulation time from the stamps of a node's messages instead of from /clock.

Works around https://github.com/ros2/rclpy/issues/1378: an rclpy node that only listens to /clock
takes a tenth of a core or more. Made for rclpy 7.1; if it is switched off, the node uses /clock.
"""

from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.node import Node
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
