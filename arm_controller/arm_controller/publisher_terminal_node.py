"""The node publisher_terminal: moves the arm to the poses that the user types."""

import os
import select
import sys
import threading
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rclpy.node import Node

from arm_controller.pose import ArmControllerError, Pose, PoseError, check_limits, read_pose, shown
from arm_controller.ros_parameters import declare_joints, declare_match_timeout_s
from arm_controller.ros_position_commands import POLL_S, PositionCommands
from arm_node.printable import printable

if TYPE_CHECKING:
    from arm_node.process import NodeProcess

PACE_S = 0.1
"""The controller keeps only the latest command, so lines from a pipe need a pause between them."""
LINGER_S = 0.2
"""Time for the last message to arrive after the input has ended."""


class DeliveryError(ArmControllerError):
    """A command was not published because it had no subscriber for too long."""


class PublisherTerminal(Node):
    """Prompts for poses and delivers them one after the other, in a thread of its own.

    Args:
        process: its shutdown ends every wait; the end of the input ends it.

    Raises:
        ParameterValueError: a given parameter is invalid.
    """

    def __init__(self, process: "NodeProcess") -> None:
        super().__init__("publisher_terminal")
        self._process = process
        self._joints = declare_joints(self)
        self._match_timeout_s = declare_match_timeout_s(self)
        self._commands = PositionCommands(self, self._joints)
        self._wake_read, self._wake_write = os.pipe()
        self._thread = threading.Thread(target=self._talk, name="dialogue")

    def start(self) -> None:
        """Begin the dialogue."""
        self._thread.start()

    def stop(self) -> None:
        """End the dialogue; return once its thread has ended."""
        os.write(self._wake_write, b"x")
        self._thread.join()

    def destroy_node(self) -> None:
        """Close the pipe as well."""
        super().destroy_node()
        os.close(self._wake_read)
        os.close(self._wake_write)

    def _talk(self) -> None:
        exit_code = 1
        try:
            exit_code = 0 if self._answer_lines() else 1
            self._process.wait(LINGER_S)
        finally:
            # A dialogue that a signal interrupts has not failed.
            if not self._process.stopping:
                self._process.stop(exit_code)

    def _answer_lines(self) -> bool:
        """Answer each line; return whether every valid one was delivered."""
        prompt = f"Enter the {len(self._joints)} Joint Variables to send (separated by spaces): "
        all_delivered = True
        # A process may start without standard input, which counts as the end of input.
        descriptor = os.open(os.devnull, os.O_RDONLY) if sys.stdin is None else sys.stdin.fileno()
        _write(prompt)
        for line in read_lines(descriptor, self._wake_read):
            try:
                self._deliver(parse_line(line, self._joints))
            except (PoseError, DeliveryError) as error:
                all_delivered = all_delivered and isinstance(error, PoseError)
                _write(f"{printable(str(error))}\n")
            _write(prompt)
        _write("\n")
        return all_delivered

    def _deliver(self, pose: Pose) -> None:
        """Publish a pose as soon as it can arrive, and wait until it has.

        Raises:
            PoseError: the pose exceeds the robot's limits.
            DeliveryError: there was no subscriber for match_timeout.
        """
        while not self._process.stopping:
            self._commands.observe()
            check_limits(pose, self._commands.limits)
            if self._commands.is_ready:
                _write(f"Publishing: {shown(pose)}\n")
                self._commands.publish(pose)
                self._process.wait(PACE_S)
                return
            if self._commands.silence_s >= self._match_timeout_s:
                raise DeliveryError(
                    f"Not published: {self._commands.listeners}. Is the position_controller active?"
                )
            self._process.wait(POLL_S)
        raise DeliveryError("Not published: the program is shutting down.")


def read_lines(descriptor: int, wake: int) -> Iterator[str]:
    """Yield the lines of a terminal, pipe or file, until something can be read from `wake`.

    A thread that is blocked in `sys.stdin.readline` cannot be joined, and the interpreter aborts if
    it exits with such a thread. The last line may lack a line break.
    """
    buffer, at_end = b"", False
    while buffer or not at_end:
        while b"\n" not in buffer and not at_end:
            readable, _, _ = select.select([descriptor, wake], [], [])
            if wake in readable:
                return
            try:
                chunk = os.read(descriptor, 4096)
            except OSError:
                # The terminal is gone or belongs to another job.
                chunk = b""
            buffer, at_end = buffer + chunk, not chunk
        if not buffer or select.select([wake], [], [], 0.0)[0]:
            return
        line, _, buffer = buffer.partition(b"\n")
        yield line.decode("utf-8", errors="replace").rstrip("\r")


def parse_line(line: str, joints: Sequence[str]) -> Pose:
    """Return the pose in a line.

    Raises:
        PoseError: the line does not have one finite number per joint.
    """
    wanted = f"Please enter exactly {len(joints)} numbers."
    words = line.split()
    if len(words) != len(joints):
        raise PoseError(f"{wanted} (There were {len(words)}.)")
    values: list[float] = []
    for word in words:
        try:
            values.append(float(word))
        except ValueError as error:
            raise PoseError(f"{wanted} ('{word}' is not a number.)") from error
    return read_pose(values, joints)


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()
