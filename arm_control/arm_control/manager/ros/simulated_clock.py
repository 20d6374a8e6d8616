"""Uses /clock as the clock of a control loop."""

from collections.abc import Callable
from math import isnan, nan

from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock as ClockMessage

from arm_control.loop.clock import Clock
from arm_control.manager.node_arguments import controller_arguments
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
ROUNDING_S = 1e-6


class SimulatedClock:
    """The time that a simulation publishes; see `arm_control.loop.clock.Clock`.

    It has its own hidden node. The manager's node cannot be used: its services block the thread
    that spins it, so time would stand still meanwhile.
    """

    def __init__(self) -> None:
        self._time_s = nan

    def now_s(self) -> float:
        """Return the latest time; NaN before the first message."""
        return self._time_s

    def listen(
        self,
        manager_node: ControllerManagerNode,
        executor: Executor,
        *,
        on_start: Callable[[], object],
        on_advance: Callable[[], object],
        on_set_back: Callable[[], object],
    ) -> Node:
        """Subscribe; return the clock's node, which the caller must destroy.

        Args:
            manager_node: provides the namespace and remaps.
            executor: runs the callbacks.
            on_start: called at the first message.
            on_advance: called at each later message.
            on_set_back: called instead if the time was set back.
        """

        def take(message: ClockMessage) -> None:
            time_s = message.clock.sec + message.clock.nanosec * 1e-9
            last_s, self._time_s = self._time_s, time_s
            if isnan(last_s):
                on_start()
            elif time_s < last_s:
                on_set_back()
            else:
                on_advance()

        node = Node(
            f"_{manager_node.get_name()}_clock",
            namespace=manager_node.get_namespace(),
            cli_args=controller_arguments(manager_node.arguments),
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        node.create_subscription(ClockMessage, "/clock", take, CLOCK_QOS)
        executor.add_node(node)
        return node


class DeadlineClock:
    """A clock slightly ahead of another, so that rounding does not miss a deadline."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def now_s(self) -> float:
        """Return the other clock's time plus one microsecond."""
        return self._clock.now_s() + ROUNDING_S
