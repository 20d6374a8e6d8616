"""The prompt of publisher_terminal: reads lines, converts them to poses, and reports errors."""

import os
import select
from collections.abc import Callable, Sequence
from types import TracebackType

from arm_controller.errors import CommandLineError, DeliveryError, PoseError
from arm_controller.joint_pose import JointPose
from arm_node.printable import printable


class InputLines:
    """Lines of a terminal, pipe or file; a context manager.

    A thread that is blocked in `sys.stdin.readline` cannot be joined, and the interpreter aborts if
    it exits with such a thread. This class waits for the input and for `end` at the same time.

    Args:
        descriptor: file descriptor to read from; it stays open.
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._wake_read, self._wake_write = os.pipe()
        self._buffer = b""
        self._at_end_of_input = False
        self._ended = False

    def __enter__(self) -> "InputLines":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        os.close(self._wake_read)
        os.close(self._wake_write)

    def read_line(self) -> str | None:
        """Block for the next line, without its line break; None after the last one or `end`.

        The last line may lack a line break. Only one thread may read.
        """
        while b"\n" not in self._buffer and not self._at_end_of_input and not self._ended:
            readable, _, _ = select.select([self._descriptor, self._wake_read], [], [])
            if self._descriptor in readable and not self._ended:
                chunk = self._read_chunk()
                self._at_end_of_input = not chunk
                self._buffer += chunk
        if not self._buffer or self._ended:
            return None
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line.decode("utf-8", errors="replace").rstrip("\r")

    def end(self) -> None:
        """Make `read_line` return None from now on. Any thread."""
        self._ended = True
        os.write(self._wake_write, b"x")

    def _read_chunk(self) -> bytes:
        try:
            return os.read(self._descriptor, 4096)
        except OSError:
            # The terminal is gone or belongs to another job, so there is nothing more to read.
            return b""


def prompt(joint_names: Sequence[str]) -> str:
    """Return the prompt."""
    return f"Enter the {len(joint_names)} Joint Variables to send (separated by spaces): "


def parse_pose_line(line: str, joint_names: Sequence[str]) -> JointPose:
    """Return the pose in a line.

    Raises:
        CommandLineError: the line does not have one number per joint.
        PoseError: a number is not finite.
    """
    wanted = f"Please enter exactly {len(joint_names)} numbers."
    words = line.split()
    if len(words) != len(joint_names):
        raise CommandLineError(f"{wanted} (There were {len(words)}.)")
    values: list[float] = []
    for word in words:
        try:
            values.append(float(word))
        except ValueError as error:
            raise CommandLineError(f"{wanted} ('{word}' is not a number.)") from error
    return JointPose.of(joint_names, values)


class TerminalDialogue:
    """Prompts for poses until the input ends.

    Args:
        joint_names: the joints of a line, in its order.
        read_line: returns the next line, or None at the end of input or of the process.
        write: shows a text to the user.
        deliver: checks a pose and publishes it as soon as it can arrive, calling its second
            argument first; raises PoseError or DeliveryError.
    """

    def __init__(
        self,
        joint_names: Sequence[str],
        read_line: Callable[[], str | None],
        write: Callable[[str], None],
        deliver: Callable[[JointPose, Callable[[], None]], None],
    ) -> None:
        self._joint_names = tuple(joint_names)
        self._read_line = read_line
        self._write = write
        self._deliver = deliver

    def run(self) -> bool:
        """Run until the end of input; return whether every valid line was delivered."""
        all_delivered = True
        while True:
            self._write(prompt(self._joint_names))
            line = self._read_line()
            if line is None:
                self._write("\n")
                return all_delivered
            try:
                self._publish(parse_pose_line(line, self._joint_names))
            except (CommandLineError, PoseError) as error:
                self._write(f"{printable(str(error))}\n")
            except DeliveryError as error:
                all_delivered = False
                self._write(f"{printable(str(error))}\n")

    def _publish(self, pose: JointPose) -> None:
        self._deliver(pose, lambda: self._write(f"Publishing: {pose}\n"))
