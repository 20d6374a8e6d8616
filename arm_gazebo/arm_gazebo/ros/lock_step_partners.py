"""Listens to the partners of a lock-stepped simulation."""

import logging
import time
from collections.abc import Callable
from contextlib import suppress
from operator import attrgetter
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.lock_step import NS_PER_S, LockStep
from arm_control.loop.supervision import failure_of
from arm_gazebo.ros.topic import message_class
from arm_node.executor_thread import ExecutorThread
from arm_node.polled_subscriptions import Unserved

NODE_NAME = "_lock_step"
"""Name of the node that receives the answers."""
SEARCH_S = 0.1
"""Interval between two searches for partners and new controllers."""
STEP_BACK_S = 1e-4
"""How long the thread that received the last answer leaves Python's lock to the loop thread.

Without it, the loop waits for rclpy's bookkeeping, and a period takes half as long again."""
DEPTH = 10
TICK_DONE = "tick_done"
TIMES: tuple[Callable[[Any], Any], ...] = (
    attrgetter("header.stamp"),
    attrgetter("stamp"),
    attrgetter("clock"),
    lambda message: message,
)
"""Where a message has its builtin_interfaces/msg/Time; the last is for a message that is one."""

logger = logging.getLogger(__name__)


class LockStepPartners:
    """Subscribes to each partner's topic once it exists, and passes its stamps to the lock-step.

    A partner is the name of a topic, or of a node that publishes its `~/tick_done`. The answers
    arrive on a thread of their own, because rclpy's executor needs a millisecond for a turn when it
    spins as many entities as a simulation has. The commands that controllers subscribe to are not
    served by the executor any more, but taken by the loop thread before each tick: whatever a
    partner sent before its answer has arrived by then.
    """

    def __init__(
        self, node: Node, executor: Executor, loop: ControlLoop, lock_step: LockStep
    ) -> None:
        """Look for the partners as soon as the executor spins.

        The executor spins this node and the controllers' nodes, in one thread.
        """
        self._node = node
        self._executor = executor
        self._loop = loop
        self._lock_step = lock_step
        self._sought = {name: _absolute(name, node) for name in lock_step.partners}
        self._unusable: set[str] = set()
        self._commands: tuple[Subscription, ...] = ()
        self._taken_by_the_loop = Unserved()
        # The fewer entities, the faster rclpy's executor.
        self._listener = Node(
            NODE_NAME,
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("start_type_description_service", value=False)],
        )
        self._thread = ExecutorThread("lock-step", SingleThreadedExecutor())
        self._thread.executor.add_node(self._listener)
        self._thread.start()
        node.create_timer(SEARCH_S, self._search, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def take_commands(self) -> None:
        """Run the callbacks of the controllers' pending messages; loop thread, before a tick."""
        for subscription in self._commands:
            what = f"a message on {subscription.topic}"
            reason = failure_of(lambda s=subscription: _serve(s), what)
            if reason:
                logger.error("%s", reason)

    def shutdown(self) -> None:
        """Stop receiving answers; the loop may still run."""
        self._thread.stop()

    def destroy(self) -> None:
        """Destroy the node that receives them, after the loop has ended."""
        self._listener.destroy_node()

    # Executor's thread

    def _search(self) -> None:
        self._take_over()
        if not self._sought:
            return
        topics = dict(self._node.get_topic_names_and_types())
        for name, absolute in tuple(self._sought.items()):
            for topic in (absolute, f"{absolute}/{TICK_DONE}"):
                infos = self._node.get_publishers_info_by_topic(topic) if topic in topics else []
                if infos and self._follow(name, topic, topics[topic][0], infos[0].qos_profile):
                    del self._sought[name]
                    break

    def _take_over(self) -> None:
        """Withdraw the subscriptions of controllers, including new ones, from the executor."""
        nodes = [node for node in self._executor.get_nodes() if node is not self._node]
        commands = tuple(s for node in nodes for s in node.subscriptions if _is_simple(s))
        for subscription in commands:
            subscription.callback_group = self._taken_by_the_loop
            # Fast DDS wakes a thread that waits for events while messages are pending.
            events: Any = subscription.event_handlers
            for event in events:
                event.callback_group = self._taken_by_the_loop
        self._commands = commands

    def _follow(self, name: str, topic: str, type_name: str, offered: QoSProfile) -> bool:
        """Subscribe; return False if the topic's messages have no stamp."""
        try:
            class_ = message_class(type_name)
        except (AttributeError, ImportError, ValueError) as error:
            self._complain(topic, f"its type {type_name} is not installed ({error})")
            return False
        stamp_of = _reader(class_)
        if stamp_of is None:
            self._complain(
                topic, f"its type {type_name} has no stamp: use std_msgs/msg/Header, for example"
            )
            return False

        def take(message: Any) -> None:
            stamp = stamp_of(message)
            if self._lock_step.record_answer(name, stamp.sec * NS_PER_S + stamp.nanosec):
                self._loop.wake()
                time.sleep(STEP_BACK_S)

        # A best-effort publisher does not match a reliable subscription.
        qos = QoSProfile(depth=DEPTH, reliability=offered.reliability)
        self._listener.create_subscription(class_, topic, take, qos)
        logger.info("lock-step with %s on %s", name, topic)
        return True

    def _complain(self, topic: str, reason: str) -> None:
        if topic not in self._unusable:
            self._unusable.add(topic)
            logger.error("lock-step with %s is not possible: %s", topic, reason)


def _is_simple(subscription: Subscription) -> bool:
    """Return whether its callback takes a message, without information about it."""
    kind = subscription._callback_type  # pyright: ignore[reportPrivateUsage]
    return kind is Subscription.CallbackType.MessageOnly


def _serve(subscription: Subscription) -> None:
    """Run the callback for each pending message, as the executor does."""
    handle = subscription.handle
    with (
        suppress(rclpy_implementation.InvalidHandle),
        handle,
    ):  # Its controller may just have been unloaded.
        while (taken := handle.take_message(subscription.msg_type, subscription.raw)) is not None:
            subscription.callback(taken[0])


def _absolute(name: str, node: Node) -> str:
    namespace = node.get_namespace().rstrip("/")
    return name if name.startswith("/") else f"{namespace}/{name}"


def _reader(class_: type[Any]) -> Callable[[Any], Any] | None:
    """Return a function that returns a message's time; None if it has none."""
    example = class_()
    for read in TIMES:
        with suppress(AttributeError):
            found = read(example)
            if hasattr(found, "sec") and hasattr(found, "nanosec"):
                return read
    return None
