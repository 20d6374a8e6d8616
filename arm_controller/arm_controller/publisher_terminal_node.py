"""The node publisher_terminal: moves the arm to the poses that the user types."""

import sys
import threading
import time
from collections.abc import Iterator, Sequence

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from arm_controller.pose import Pose, PoseError, read_pose, shown
from arm_controller.ros_arm import POLL_S, PositionCommands
from arm_controller.ros_node import declare_joints, declare_match_timeout_s, run

PACE_S = 0.1
"""The controller keeps only the latest command, so lines from a pipe need a pause between them."""
LINGER_S = 0.2
"""Time for the last message to arrive after the input has ended."""


class PublisherTerminal(Node):
    """Prompts for poses and delivers them one after the other."""

    def __init__(self) -> None:
        super().__init__("publisher_terminal")
        self._joints = declare_joints(self)
        self._match_timeout_s = declare_match_timeout_s(self)
        self._commands = PositionCommands(self, self._joints)

    def talk(self) -> int:
        """Answer each line until the input ends; return 1 if a valid one was not delivered."""
        exit_code = 0
        prompt = f"Enter the {len(self._joints)} Joint Variables to send (separated by spaces): "
        for line in typed_lines(prompt):
            try:
                problem = self._deliver(parse_line(line, self._joints))
                exit_code = 1 if problem else exit_code
            except PoseError as error:
                problem = str(error)
            if problem:
                _write(f"{problem}\n")
        _write("\n")
        time.sleep(LINGER_S)
        return exit_code

    def _deliver(self, pose: Pose) -> str:
        """Publish a pose as soon as it can arrive; return why it was not published, or "".

        Raises:
            PoseError: the pose exceeds the robot's limits.
        """
        while True:
            topic = self._commands.observe()
            self._commands.check(pose)
            if self._commands.is_ready:
                _write(f"Publishing: {shown(pose)}\n")
                self._commands.publish(pose)
                time.sleep(PACE_S)
                return ""
            if topic.silence_s >= self._match_timeout_s:
                listeners = topic.describe_subscribers()
                return f"Not published: {listeners}. Is the position_controller active?"
            time.sleep(POLL_S)


def typed_lines(prompt: str) -> Iterator[str]:
    """Yield what is typed, until the input ends; a program may start without any input."""
    _write(prompt)
    try:
        for line in sys.stdin or ():
            yield line
            _write(prompt)
    except OSError:
        return  # The terminal is gone or belongs to another job.


def parse_line(line: str, joints: Sequence[str]) -> Pose:
    """Return the pose in a line.

    Raises:
        PoseError: the line does not have one finite number per joint.
    """
    wanted = f"Please enter exactly {len(joints)} numbers."
    words = line.split()
    if len(words) != len(joints):
        raise PoseError(f"{wanted} (There were {len(words)}.)")
    try:
        return read_pose([float(word) for word in words], joints)
    except ValueError as error:
        raise PoseError(f"{wanted} ({error}.)") from error


def talk_while_spinning(node: PublisherTerminal) -> int:
    """Talk in the main thread, which Ctrl-C interrupts; serve the node in another one."""
    if sys.stdin is not None:
        sys.stdin.reconfigure(errors="replace")  # pyright: ignore[reportAttributeAccessIssue]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    is_over = threading.Event()

    def spin() -> None:
        while not is_over.is_set():
            executor.spin_once(timeout_sec=0.2)

    spinning = threading.Thread(target=spin)
    spinning.start()
    try:
        return node.talk()
    finally:
        is_over.set()
        spinning.join()
        executor.shutdown()


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


def main() -> int:
    """Publish the poses that the user types; return 1 if a valid line was not delivered."""
    return run(PublisherTerminal, talk_while_spinning)
