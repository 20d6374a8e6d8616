"""A program that takes a managed node through transitions, or prints those that it makes.

`change NODE NUMBER...` waits for the node, makes the transitions in that order, and fails at the
first one that fails. `watch NODE` prints a line for each transition: the labels of the states
before and after it, and its own. It ends when the node does.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from launch_py.substitution import join_names

if TYPE_CHECKING:
    from rclpy.node import Node

POLL_S = 0.1


def main(words: Sequence[str]) -> int:
    """Run the program; return its exit code."""
    import rclpy
    from rclpy.executors import ExternalShutdownException
    from rclpy.utilities import try_shutdown

    rclpy.init(args=[])
    node = rclpy.create_node("launch_lifecycle", start_parameter_services=False)
    try:
        if words[0] == "watch":
            return _watch(node, words[1])
        return _change(node, words[1], [int(word) for word in words[2:]])
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        node.destroy_node()
        try_shutdown()


def _change(node: Node, name: str, numbers: Sequence[int]) -> int:
    import rclpy
    from lifecycle_msgs.srv import ChangeState

    client = node.create_client(ChangeState, join_names(name, "change_state"))
    while not client.service_is_ready():
        rclpy.spin_once(node, timeout_sec=POLL_S)
    for number in numbers:
        request = ChangeState.Request()
        request.transition.id = number
        answer = client.call_async(request)
        rclpy.spin_until_future_complete(node, answer)
        result = answer.result()
        if result is None or not result.success:
            sys.stderr.write(f"Failed to make transition {number} for LifecycleNode '{name}'\n")
            return 1
    return 0


def _watch(node: Node, name: str) -> int:
    import rclpy
    from lifecycle_msgs.msg import TransitionEvent

    from launch_py.ros.lifecycle import WATCHING

    def take(event: TransitionEvent) -> None:
        label = event.transition.label or "unnamed"
        say(f"{event.start_state.label} {event.goal_state.label} {label}")

    topic = join_names(name, "transition_event")
    subscription = node.create_subscription(TransitionEvent, topic, take, 10)
    heard = False
    while True:
        rclpy.spin_once(node, timeout_sec=POLL_S)
        publishers = subscription.get_publisher_count()
        if publishers and not heard:
            heard = True
            say(WATCHING)
        elif heard and not publishers:
            return 0


def say(line: str) -> None:
    """Print a line for the launcher, which reads each at once."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
